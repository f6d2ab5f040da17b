#include "database.hpp"

#include <cstdlib>
#include <filesystem>

#include "posevote/core/error.hpp"

namespace posevote::cli {
namespace {

namespace fs = std::filesystem;

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

fs::path data_folder() {
  const std::string xdg = environment("XDG_DATA_HOME"), home = environment("HOME");
  if (!xdg.empty()) return xdg;
  if (!home.empty()) return fs::path(home) / ".local" / "share";
  throw Error(ErrorCode::io,
              "there is no home folder to keep objects in; name a database with --db");
}

}  // namespace

void add_database(CLI::App& command, std::string& path) {
  command
      .add_option("--db", path,
                  "Database of objects: a file, or postgresql://USER@HOST/NAME (leave the password "
                  "to ~/.pgpass); default: $POSEVOTE_DB, else posevote/objects.db in the XDG data "
                  "folder")
      ->type_name("DB");
}

std::string database_path(const std::string& given) {
  if (!given.empty()) return given;
  const std::string named = environment("POSEVOTE_DB");
  return named.empty() ? (data_folder() / "posevote" / "objects.db").string() : named;
}

bool database_exists(const std::string& given) {
  std::error_code ignored;
  const std::string path = database_path(given);
  return is_server_address(path) || fs::exists(path, ignored);
}

std::unique_ptr<ObjectStore> open_database(const std::string& given, Access access) {
  const std::string path = database_path(given);
  if (access == Access::create && given.empty() && environment("POSEVOTE_DB").empty()) {
    std::error_code error;
    fs::create_directories(fs::path(path).parent_path(), error);
    if (error)
      throw Error(ErrorCode::io,
                  "cannot make the folder of database '" + path + "': " + error.message());
  }
  return open_store(path, access);
}

void choose_features(FeatureOptions& options, const ObjectStore* store, const std::string& kind) {
  const auto record = store ? store->features() : std::nullopt;
  if (record && (kind.empty() || recorded_options(*record).kind == kind))
    options = recorded_options(*record);
  else if (!kind.empty())
    options.kind = kind;
}

void require_features(const FeatureOptions& options, const ObjectStore& store) {
  const auto record = store.features();
  if (record && record->signature != options.signature())
    throw Error(ErrorCode::feature_mismatch,
                "database '" + store.location() + "' holds features '" + record->signature +
                    "', not '" + options.signature() +
                    "'; leave out --features, or convert it: posevote objects rebuild");
}

}  // namespace posevote::cli
