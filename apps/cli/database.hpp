// The database that `--db` names.
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "posevote/store/open_store.hpp"

namespace posevote::cli {

/// Adds `--db`. Left empty when it is not given; see `database_path`.
void add_database(CLI::App& command, std::string& path);

/// `given`, else $POSEVOTE_DB, else posevote/objects.db in the XDG data folder. Throws Error{io}
/// when none of the variables is set that say where that is.
[[nodiscard]] std::string database_path(const std::string& given);

/// Servers' databases count as there: they are asked when they are opened.
[[nodiscard]] bool database_exists(const std::string& given);

/// Opens the database; with Access::create the default folder is made, too.
[[nodiscard]] std::unique_ptr<ObjectStore> open_database(const std::string& given, Access access);

/// Sets `options` to those that the database's features were made with, if there are any, and then
/// to `kind` (--features; "": not given).
void choose_features(FeatureOptions& options, const ObjectStore* store, const std::string& kind);

/// Throws Error{feature_mismatch} when the database holds features that must not be mixed with
/// these.
void require_features(const FeatureOptions& options, const ObjectStore& store);

}  // namespace posevote::cli
