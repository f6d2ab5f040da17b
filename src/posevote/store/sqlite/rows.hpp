// Views, features and provenance as columns of a row.
#pragma once

#include <SQLiteCpp/Column.h>
#include <SQLiteCpp/Statement.h>

#include "posevote/store/blob.hpp"
#include "posevote/store/taught_view.hpp"

namespace posevote::sqlite {

/// The bytes of a column, valid until the statement moves on.
[[nodiscard]] BlobView blob_of(const SQLite::Column& column);
[[nodiscard]] Blob copy_of(const SQLite::Column& column);

/// The rows' columns have the names of the tables' (see schema.cpp).
[[nodiscard]] Provenance provenance_of(SQLite::Statement& row);
[[nodiscard]] Features features_of(SQLite::Statement& row);
[[nodiscard]] double yaw_of(const SQLite::Column& column);  ///< NaN for NULL
/// Without pictures.
[[nodiscard]] View view_of(SQLite::Statement& row);

/// Bind the parameters of the same names, by copy.
void bind_blob(SQLite::Statement& statement, const char* name, const Blob& blob);
void bind_provenance(SQLite::Statement& statement, const Provenance& provenance);
void bind_features(SQLite::Statement& statement, const Features& features);
void bind_view(SQLite::Statement& statement, const View& view);

}  // namespace posevote::sqlite
