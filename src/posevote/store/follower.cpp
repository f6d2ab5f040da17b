#include "posevote/store/follower.hpp"

#include "posevote/core/error.hpp"

namespace posevote {
namespace {

// How long the end of a follower may take; changes are learned of at once, whatever it is.
constexpr std::chrono::milliseconds slice(200);

}  // namespace

Follower::Follower(std::shared_ptr<const ObjectStore> store, std::int64_t known, Swap swap,
                   const LoadOptions& options)
    : store_(std::move(store)),
      swap_(std::move(swap)),
      options_(options),
      known_(known),
      thread_([this] { run(); }) {}

Follower::~Follower() {
  stop_ = true;
  thread_.join();
}

std::string Follower::problem() const {
  const std::lock_guard lock(mutex_);
  return problem_;
}

void Follower::attempt() {
  if (!store_->wait_for_change(known_, slice)) return;
  const std::int64_t version = store_->version();  // what is changed from now on counts as new
  swap_(store_->load(options_));
  known_ = version;
}

void Follower::run() {
  while (!stop_) {
    std::string problem;
    try {
      attempt();
    } catch (const Error& error) {
      problem = error.what();
    }
    const bool failed = !problem.empty();
    {
      const std::lock_guard lock(mutex_);
      problem_ = std::move(problem);
    }
    if (failed && !stop_) std::this_thread::sleep_for(slice);
  }
}

}  // namespace posevote
