#include "logic/active_set.hpp"

#include <algorithm>

namespace posevote::logic {

std::shared_ptr<const ModelSet> select_objects(std::shared_ptr<const ModelSet> all,
                                               const std::vector<std::string>& names) {
  if (names.empty()) return all;
  std::vector<ObjectModel> chosen;
  for (const ObjectModel& object : all->objects())
    if (std::find(names.begin(), names.end(), object.name) != names.end()) chosen.push_back(object);
  return std::make_shared<const ModelSet>(all->signature(), std::move(chosen), all->impostors());
}

}  // namespace posevote::logic
