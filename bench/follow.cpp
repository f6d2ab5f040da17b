// From a change to its being known: milliseconds from the end of teaching, in one process's eyes,
// to another recogniser's swapped snapshot, its index included.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <condition_variable>
#include <cstdio>
#include <iostream>

#include "posevote/core/error.hpp"
#include "posevote/core/stopwatch.hpp"
#include "posevote/recognize/recognizer.hpp"
#include "posevote/store/follower.hpp"
#include "posevote/store/made_views.hpp"
#include "posevote/store/open_store.hpp"

namespace {

using namespace posevote;

struct Settings {
  std::vector<std::string> databases;
  int views = 200, features = 300, changes = 50;
};

void measure(const Settings& settings, const std::string& location) {
  const std::shared_ptr<ObjectStore> here = open_store(location);
  const auto there = open_store(location);
  const RecognizeOptions options;
  const FeatureRecord record = record_features(options.feature);
  if (!here->list().empty())
    throw Error(ErrorCode::invalid_argument, "'" + here->location() + "' is not empty");
  there->transact([&] {
    for (int i = 0; i < settings.views; ++i)
      there->add_view("object " + std::to_string(i / 10), made_view(i, settings.features), record);
  });
  const std::int64_t version = here->version();
  Recognizer recognizer(here->load(), options);
  std::mutex mutex;
  std::condition_variable swapped;
  const auto known = [&] { return recognizer.models()->views().size(); };
  std::vector<double> times_ms;
  {
    const Follower follower(here, version, [&](const auto& models) {
      recognizer.set_models(models);
      const std::lock_guard lock(mutex);
      swapped.notify_all();
    });
    for (int i = 0; i < settings.changes; ++i) {
      const std::size_t wanted = known() + 1;
      there->add_view("new " + std::to_string(i), made_view(10000 + i, settings.features), record);
      Stopwatch watch;
      std::unique_lock lock(mutex);
      swapped.wait(lock, [&] { return known() == wanted; });
      times_ms.push_back(watch.lap());
    }
  }
  std::ranges::sort(times_ms);
  std::printf("%-12s %5d views, %3d changes: median %6.1f ms, worst %6.1f ms\n",
              is_server_address(location) ? "PostgreSQL" : "SQLite", settings.views,
              settings.changes, times_ms[times_ms.size() / 2], times_ms.back());
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("How soon a recogniser knows what another program teaches.", "bench_follow");
  Settings settings;
  app.add_option("DATABASE", settings.databases, "Empty ones: files or addresses")->required();
  app.add_option("--views", settings.views, "Views that are there")->capture_default_str();
  app.add_option("--features", settings.features, "Of each view")->capture_default_str();
  app.add_option("--changes", settings.changes, "Views taught one after the other")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    for (const std::string& database : settings.databases) measure(settings, database);
    return 0;
  } catch (const Error& error) {
    std::cerr << "bench_follow: " << error.what() << '\n';
    return 1;
  }
}
