// The tables of a SQLite database and how older ones become newer ones.
#pragma once

#include <SQLiteCpp/Database.h>

namespace posevote::sqlite {

/// In the file's header: "pvot".
constexpr int application_id = 0x70766f74;

/// Number of migration steps, kept in the file's header as user_version.
extern const int newest_schema;

/// Applies the steps that the database lacks, up to schema `version`, as one change. Safe when
/// several processes do it at once.
void migrate(SQLite::Database& database, int version = newest_schema);

}  // namespace posevote::sqlite
