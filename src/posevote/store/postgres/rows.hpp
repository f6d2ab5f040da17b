// Views, features and provenance as columns of a row, and as parameters.
#pragma once

#include <pqxx/pqxx>

#include "posevote/store/blob.hpp"
#include "posevote/store/taught_view.hpp"

namespace posevote::postgres {

[[nodiscard]] Blob blob_of(const pqxx::field& field);
[[nodiscard]] pqxx::binarystring bytes(const Blob& blob);
/// As short as it reads back the same.
[[nodiscard]] std::string number_text(double value);

/// The rows' columns have the names of the tables' (see schema.cpp).
[[nodiscard]] Provenance provenance_of(const pqxx::row& row);
[[nodiscard]] Features features_of(const pqxx::row& row);
[[nodiscard]] double yaw_of(const pqxx::field& field);  ///< NaN for NULL
/// Without pictures.
[[nodiscard]] View view_of(const pqxx::row& row);

}  // namespace posevote::postgres
