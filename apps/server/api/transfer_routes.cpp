// /api/export and /api/import: objects as one portable file.
#include <fstream>

#include "api/routes.hpp"
#include "http/problem.hpp"
#include "json.hpp"
#include "posevote/image/read_image.hpp"
#include "posevote/store/transfer.hpp"

namespace posevote::server {
namespace {

/// A file of the server's own that is gone when this ends.
struct ScratchFile {
  std::string path;
  explicit ScratchFile(const Studio& studio)
      : path(studio.folder.trash() + "/transfer-" + random_hex(8)) {}
  ~ScratchFile() { remove_database_file(path); }
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;
};

Response export_all(const Request& request, Studio& studio) {
  std::vector<std::string> names;
  const auto [begin, end] = request.query.equal_range("object");
  for (auto at = begin; at != end; ++at) names.push_back(at->second);
  const JobSlots::Slot slot(studio.jobs);
  const ScratchFile file(studio);
  export_objects(studio.catalogue.store(), file.path, names);
  Response response = bytes_response("application/octet-stream", read_bytes(file.path));
  response.headers.emplace("Content-Disposition", "attachment; filename=\"objects.posevote\"");
  return response;
}

OnConflict parse_existing(const Request& request) {
  const std::string existing = request.find("existing").value_or("refuse");
  if (existing == "refuse") return OnConflict::refuse;
  if (existing == "merge") return OnConflict::merge;
  if (existing == "replace") return OnConflict::replace;
  throw invalid("existing must be refuse, merge or replace");
}

Response import(const Request& request, Studio& studio) {
  const OnConflict existing = parse_existing(request);
  const ScratchFile file(studio);
  std::ofstream stream(file.path, std::ios::binary);
  request.receive_body(most_bytes(studio.limits.import_mb),
                       [&](const char* data, std::size_t size) {
                         stream.write(data, static_cast<std::streamsize>(size));
                       });
  stream.close();
  if (!stream) throw Error(ErrorCode::io, "the file could not be kept; is the disk full?");
  const JobSlots::Slot slot(studio.jobs);
  TransferResult result;
  try {
    result = import_objects(file.path, studio.catalogue.store(), {}, existing);
  } catch (const Error& error) {
    if (error.code() == ErrorCode::already_exists)
      throw Problem(409, "already_exists",
                    "an object of the file has the name of one that is there already; merge or "
                    "replace it");
    if (error.code() == ErrorCode::feature_mismatch) throw;
    throw Problem(422, "database_unusable", "this is no exported file, or it is damaged");
  }
  studio.catalogue.refresh();
  return json_response({{"objects", result.objects},
                        {"views_added", result.views_added},
                        {"views_known", result.views_known}});
}

}  // namespace

void add_transfer_routes(Router& router, Studio& studio) {
  router.add({"GET", "/api/export", Entry::protected_,
              [&studio](Request& request) { return export_all(request, studio); }});
  router.add({"POST", "/api/import", Entry::protected_,
              [&studio](Request& request) { return import(request, studio); }});
}

}  // namespace posevote::server
