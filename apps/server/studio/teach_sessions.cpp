#include "studio/teach_sessions.hpp"

#include <algorithm>
#include <filesystem>

#include "http/access.hpp"
#include "http/problem.hpp"

namespace posevote::server {
namespace {

constexpr const char* kEnding = ".posevote";

}  // namespace

TeachSessions::TeachSessions(std::string folder, const Limits& limits,
                             const std::function<void(const std::string&)>& problem)
    : folder_(std::move(folder)), limits_(limits) {
  for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
    const std::string id = entry.path().stem().string();
    if (entry.path().extension() != kEnding) continue;
    try {
      sessions_[id] = std::make_shared<TeachSession>(id, entry.path().string(), limits_.wait_s);
    } catch (const Error& error) {
      problem(std::string("a teach session of an earlier run cannot be taken up: ") + error.what());
    }
  }
}

std::shared_ptr<TeachSession> TeachSessions::create(ObjectModel of) {
  expire();
  const std::string id = random_hex(16);
  const std::lock_guard lock(mutex_);
  if (static_cast<int>(sessions_.size()) >= limits_.sessions)
    throw too_many("there are " + std::to_string(sessions_.size()) +
                   " teach sessions in hand; save or discard one first");
  return sessions_[id] = std::make_shared<TeachSession>(id, folder_ + "/" + id + kEnding,
                                                        limits_.wait_s, std::move(of));
}

std::shared_ptr<TeachSession> TeachSessions::find(const std::string& id) const {
  const std::lock_guard lock(mutex_);
  const auto at = sessions_.find(id);
  if (at == sessions_.end()) throw not_found("there is no such teach session any more");
  return at->second;
}

std::vector<std::shared_ptr<TeachSession>> TeachSessions::all() const {
  std::vector<std::shared_ptr<TeachSession>> all;
  {
    const std::lock_guard lock(mutex_);
    for (const auto& [id, session] : sessions_) all.push_back(session);
  }
  std::ranges::stable_sort(all, std::ranges::less(), &TeachSession::begun);
  return all;
}

void TeachSessions::discard(const std::string& id) {
  const auto session = find(id);
  session->discard();
  const std::lock_guard lock(mutex_);
  sessions_.erase(id);
}

void TeachSessions::expire() {
  for (const auto& session : all())
    if (session->idle_s() > limits_.session_idle_s) {
      session->discard();
      const std::lock_guard lock(mutex_);
      sessions_.erase(session->id());
    }
}

}  // namespace posevote::server
