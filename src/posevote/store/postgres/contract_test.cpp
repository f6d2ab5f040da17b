// The contract of all backends, kept by this one.
#include "posevote/store/object_store_contract.hpp"
#include "posevote/store/postgres/postgres_store.hpp"
#include "posevote/store/postgres/test_server.hpp"

namespace posevote::contract {
namespace {

const Backend postgres_backend{"postgres", [](const ScratchFolder& folder) {
                                 const postgres::TestServer server;
                                 if (!server.runs()) return std::unique_ptr<ObjectStore>();
                                 const std::string database = folder.path.filename().string();
                                 server.make(database);
                                 return open_postgres_store(server.address(database));
                               }};

INSTANTIATE_TEST_SUITE_P(Postgres, Store, testing::Values(postgres_backend));

}  // namespace
}  // namespace posevote::contract
