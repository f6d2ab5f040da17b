// A recogniser for a database, made ready with what earlier ones left beside the objects.
#pragma once

#include <memory>

#include "posevote/recognize/recognizer.hpp"
#include "posevote/store/object_store.hpp"

namespace posevote {

/// `models` were loaded from `store` when it had `version` or a newer one. What had to be found out
/// about many features is kept in the store for the next time, where that is permitted.
[[nodiscard]] std::unique_ptr<Recognizer> make_recognizer(ObjectStore& store, std::int64_t version,
                                                          std::shared_ptr<const ModelSet> models,
                                                          const RecognizeOptions& options);

}  // namespace posevote
