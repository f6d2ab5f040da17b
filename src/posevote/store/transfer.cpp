#include "posevote/store/transfer.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <filesystem>

#include "posevote/core/error.hpp"
#include "posevote/store/sqlite/sqlite_store.hpp"

namespace posevote {
namespace {

namespace fs = std::filesystem;

bool has_object(const std::vector<ObjectSummary>& objects, const std::string& name) {
  return std::ranges::find(objects, name, &ObjectSummary::name) != objects.end();
}

std::vector<std::string> names_to_copy(const ObjectStore& from,
                                       const std::vector<std::string>& names) {
  const auto objects = from.list();
  std::vector<std::string> all;
  if (names.empty())
    for (const ObjectSummary& object : objects) all.push_back(object.name);
  for (const std::string& name : names) {
    if (!has_object(objects, name))
      throw Error(ErrorCode::not_found, "'" + from.location() + "' holds no object '" + name + "'");
    if (std::ranges::find(all, name) == all.end()) all.push_back(name);
  }
  if (all.empty()) throw Error(ErrorCode::not_found, "'" + from.location() + "' holds no objects");
  return all;
}

/// Gives the finished file its name, refusing to replace another one.
void publish(const std::string& made, const std::string& path, bool overwrite) {
  std::error_code error;
  if (overwrite) {
    fs::rename(made, path, error);
  } else {
    fs::create_hard_link(made, path, error);
    if (error == std::errc::file_exists)
      throw Error(ErrorCode::already_exists, "file '" + path + "' exists already");
    if (error) {  // a file system without hard links
      error.clear();
      if (fs::exists(path))
        throw Error(ErrorCode::already_exists, "file '" + path + "' exists already");
      fs::rename(made, path, error);
    }
  }
  if (error) throw Error(ErrorCode::io, "cannot write file '" + path + "': " + error.message());
}

/// A file that is gone when this ends.
struct ScratchFile {
  std::string path;
  ~ScratchFile() {
    std::error_code ignored;
    for (const char* suffix : {"", "-journal"}) fs::remove(path + suffix, ignored);
  }
};

/// Fills a new database by `fill`; it appears as `path` when it is complete.
template <class Fill>
TransferResult write_file(const std::string& path, bool overwrite, const Fill& fill) {
  if (!overwrite && fs::exists(path))
    throw Error(ErrorCode::already_exists, "file '" + path + "' exists already");
  const ScratchFile scratch{path + ".part" + std::to_string(getpid())};
  TransferResult result;
  {
    SqliteOptions options;
    options.write_ahead = false;
    const auto to = open_sqlite_store(scratch.path, options);
    result = fill(*to);
  }
  publish(scratch.path, path, overwrite);
  return result;
}

}  // namespace

TransferResult copy_objects(const ObjectStore& from, ObjectStore& to,
                            const std::vector<std::string>& names, OnConflict on_conflict) {
  const auto wanted = names_to_copy(from, names);
  const auto features = from.features();
  TransferResult result;
  to.transact([&] {
    const auto present = to.list();
    for (const std::string& name : wanted) {
      if (has_object(present, name)) {
        if (on_conflict == OnConflict::refuse)
          throw Error(ErrorCode::already_exists, "'" + to.location() + "' holds an object '" +
                                                     name + "' already; use --merge or --replace");
        if (on_conflict == OnConflict::replace) to.remove_object(name);
      }
      for (const ViewSummary& summary : from.views(name)) {
        const AddResult added = to.add_view(name, from.view(name, summary.id), features.value());
        ++(added.added ? result.views_added : result.views_known);
      }
      ++result.objects;
    }
  });
  return result;
}

TransferResult export_objects(const ObjectStore& from, const std::string& path,
                              const std::vector<std::string>& names, bool overwrite) {
  return write_file(path, overwrite, [&](ObjectStore& to) {
    return copy_objects(from, to, names, OnConflict::refuse);
  });
}

TransferResult save_copy(const ObjectStore& from, const std::string& path) {
  return write_file(path, false, [&](ObjectStore& to) {
    TransferResult result;
    to.transact([&] {
      if (!from.list().empty()) result = copy_objects(from, to, {}, OnConflict::refuse);
      for (const ImpostorSummary& impostor : from.impostors())
        to.add_impostor(from.impostor(impostor.id), from.features().value());
    });
    return result;
  });
}

TransferResult import_objects(const std::string& path, ObjectStore& to,
                              const std::vector<std::string>& names, OnConflict on_conflict) {
  SqliteOptions options;
  options.access = Access::read_only;
  const auto from = open_sqlite_store(path, options);
  return copy_objects(*from, to, names, on_conflict);
}

}  // namespace posevote
