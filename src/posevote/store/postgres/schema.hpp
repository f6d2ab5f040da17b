// The tables in a PostgreSQL database and how older ones become newer ones.
#pragma once

#include <pqxx/pqxx>
#include <string>

namespace posevote::postgres {

/// Number of migration steps, kept in posevote.meta.
extern const int newest_schema;

/// Writers take this lock, "pvot", so that they come one after the other.
constexpr const char* writer_lock = "SELECT pg_advisory_xact_lock(1886809972)";

/// What is told to LISTEN when something has changed.
constexpr const char* channel = "posevote";

/// Number of the schema; 0: there is none.
[[nodiscard]] int present_schema(pqxx::transaction_base& work);

/// Whether the user may change the schema: owns it, or may make it.
[[nodiscard]] bool may_migrate(pqxx::transaction_base& work);

/// Applies the steps that the database lacks, up to schema `version`. Safe when several do it at
/// once.
void migrate(pqxx::transaction_base& work, int version = newest_schema);

}  // namespace posevote::postgres
