#include "prepared_recognizer.hpp"

#include "posevote/core/error.hpp"

namespace posevote {
namespace {

constexpr const char* kKey = "recognizer";
constexpr std::size_t kWorthKeeping = 2000;  // features that took some tens of milliseconds
constexpr std::size_t kScanned = 3;          // lists of an index that looks at everything

}  // namespace

std::unique_ptr<Recognizer> make_recognizer(ObjectStore& store, std::int64_t version,
                                            std::shared_ptr<const ModelSet> models,
                                            const RecognizeOptions& options) {
  auto recognizer =
      std::make_unique<Recognizer>(std::move(models), options, store.derived(kKey).bytes);
  const IndexStatistics index = recognizer->index_statistics();
  if (index.assigned < kWorthKeeping || index.lists <= kScanned || store.read_only())
    return recognizer;
  try {
    store.set_derived(kKey, {version, recognizer->save_prepared()});
  } catch (const Error&) {
    // Not permitted, disk full, busy: the next start takes longer, and that is all.
  }
  return recognizer;
}

}  // namespace posevote
