// All teach sessions in hand.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "studio/teach_session.hpp"

namespace posevote::server {

/// Safe for many threads.
class TeachSessions {
 public:
  /// Takes up again what an earlier run left in `folder`; `problem` is told of what cannot be.
  TeachSessions(std::string folder, const Limits& limits,
                const std::function<void(const std::string&)>& problem);

  /// Throws Problem 429 when there are too many. `of`: see TeachSession.
  [[nodiscard]] std::shared_ptr<TeachSession> create(ObjectModel of = {});
  /// Throws Problem 404.
  [[nodiscard]] std::shared_ptr<TeachSession> find(const std::string& id) const;
  [[nodiscard]] std::vector<std::shared_ptr<TeachSession>> all() const;  ///< oldest first
  /// Throws Problem 404.
  void discard(const std::string& id);
  /// Discards those that nobody has used for long.
  void expire();

 private:
  std::string folder_;
  Limits limits_;
  mutable std::mutex mutex_;
  std::map<std::string, std::shared_ptr<TeachSession>> sessions_;
};

}  // namespace posevote::server
