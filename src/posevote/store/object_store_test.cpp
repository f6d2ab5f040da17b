#include "posevote/store/object_store_contract.hpp"
#include "posevote/store/sqlite/sqlite_store.hpp"

namespace posevote::contract {
namespace {

const Backend sqlite{"sqlite", [](const ScratchFolder& folder) {
                       return open_sqlite_store(folder.file("objects.db"));
                     }};

INSTANTIATE_TEST_SUITE_P(Sqlite, Store, testing::Values(sqlite));

}  // namespace
}  // namespace posevote::contract
