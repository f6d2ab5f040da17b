// bench_server_soak [--clients N] [--seconds S] [--fps F] [--dataset FOLDER]
//
// Starts `posevote serve` on a new database, teaches all views of a dataset (data/demo when none is
// named), posts its test pictures as a client's camera would, and watches with N clients, every
// second one frames, the others events. Prints one JSON object: memory at the beginning and after
// each twelfth of the time, frames and results a second, the time from posting a frame until
// clients have it and its result (percentiles, and the median of each twelfth: it would grow with a
// queue; ms), frames that were left out.
#include <fcntl.h>
#include <httplib.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "posevote/evaluate/dataset.hpp"

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using Json = nlohmann::ordered_json;

struct Options {
  int clients = 8;
  double seconds = 60;
  double fps = 15;
  fs::path dataset = "data/demo";
};

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

std::string content(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class Served {
 public:
  explicit Served(const std::string& folder) {
    const std::string program = fs::read_symlink("/proc/self/exe").parent_path() / "posevote";
    const std::string out = folder + "/out.txt", database = folder + "/objects.db";
    pid_ = fork();
    if (pid_ == 0) {
      dup2(open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDOUT_FILENO);
      execl(program.c_str(), program.c_str(), "serve", "--listen", "127.0.0.1:0", "--db",
            database.c_str(), static_cast<char*>(nullptr));
      _exit(127);
    }
    const std::string before = "http://127.0.0.1:";
    for (int i = 0; i < 6000 && port_ == 0; ++i) {
      const std::string said = content(out);
      if (said.starts_with(before) && said.ends_with('\n'))
        port_ = std::stoi(said.substr(before.size()));
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    if (port_ == 0) throw std::runtime_error("posevote serve does not begin");
  }
  ~Served() {
    kill(pid_, SIGTERM);
    waitpid(pid_, nullptr, 0);
  }
  Served(const Served&) = delete;
  Served& operator=(const Served&) = delete;

  httplib::Client client() const {
    httplib::Client client("127.0.0.1", port_);
    client.set_keep_alive(true);
    client.set_tcp_nodelay(true);
    client.set_read_timeout(30);
    return client;
  }

  double metric(const std::string& name) const {
    const auto result = client().Get("/metrics");
    const std::size_t at = result ? result->body.find("\n" + name + " ") : std::string::npos;
    return at == std::string::npos ? 0 : std::stod(result->body.substr(at + name.size() + 2));
  }

 private:
  int pid_ = -1;
  int port_ = 0;
};

/// Returns how many views were taken.
int teach(const Served& server, const posevote::Dataset& dataset) {
  int taught = 0;
  auto client = server.client();
  for (const auto& object : dataset.objects)
    for (const auto& view : object.views) {
      httplib::MultipartFormDataItems parts{
          {"picture", content(dataset.path(view.image)), "picture.jpg", "image/jpeg"}};
      if (!view.background.empty())
        parts.push_back(
            {"background", content(dataset.path(view.background)), "background.jpg", "image/jpeg"});
      const auto result = client.Post("/api/objects/" + object.name + "/views", parts);
      if (result && result->status == 201) ++taught;
    }
  return taught;
}

struct Delay {
  Clock::time_point when;
  double ms;
};

/// When frames were posted, and how long they took to arrive.
class Times {
 public:
  void posted(std::int64_t frame, Clock::time_point when) {
    const std::lock_guard lock(mutex_);
    posted_[frame] = when;
  }
  void arrived(std::int64_t frame, std::vector<Delay>& delays) {
    const auto now = Clock::now();
    const std::lock_guard lock(mutex_);
    const auto at = posted_.find(frame);
    if (at != posted_.end())
      delays.push_back({now, std::chrono::duration<double, std::milli>(now - at->second).count()});
  }

 private:
  std::mutex mutex_;
  std::map<std::int64_t, Clock::time_point> posted_;
};

/// Posts the test pictures one after the other at a steady rate.
void post_frames(const Served& server, const posevote::Dataset& dataset, double fps, Times& times,
                 const std::atomic<bool>& stop) {
  std::vector<std::string> pictures;
  for (const auto& test : dataset.tests) pictures.push_back(content(dataset.path(test.image)));
  auto client = server.client();
  auto due = Clock::now();
  std::int64_t next = server.metric("posevote_frames_total") > 0 ? -1 : 0;
  for (std::size_t i = 0; !stop; ++i) {
    std::this_thread::sleep_until(due);
    due = std::max(
        due + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1 / fps)),
        Clock::now());
    const auto begin = Clock::now();
    if (next >= 0) times.posted(next, begin);  // it may arrive before the answer does
    const auto result = client.Post("/api/live/frame", pictures[i % pictures.size()], "image/jpeg");
    if (!result || result->status != 200) continue;
    const std::int64_t number = Json::parse(result->body)["frame"];
    times.posted(number, begin);
    next = number + 1;
  }
}

/// Watches a stream; `mark` stands before each frame's number.
void watch(const Served& server, const std::string& path, const std::string& mark, Times& times,
           std::vector<Delay>& delays, const std::atomic<bool>& stop) {
  auto client = server.client();
  std::string text;
  client.Get(path, [&](const char* data, std::size_t size) {
    text.append(data, size);
    std::size_t at = 0, done = 0;
    while ((at = text.find(mark, done)) != std::string::npos &&
           text.size() > at + mark.size() + 20) {
      times.arrived(std::stoll(text.substr(at + mark.size(), 20)), delays);
      done = at + mark.size();
    }
    text.erase(0, std::max(done, text.size() > 100 ? text.size() - 100 : 0));
    return !stop.load();
  });
}

constexpr int kSteps = 12;

/// Of all clients together.
Json summarize(const std::vector<std::vector<Delay>>& of_clients, Clock::time_point begin,
               double seconds) {
  std::vector<double> all;
  std::vector<std::vector<double>> steps(kSteps);
  for (const auto& delays : of_clients)
    for (const Delay& delay : delays) {
      const double at = std::chrono::duration<double>(delay.when - begin).count() / seconds;
      all.push_back(delay.ms);
      steps[static_cast<std::size_t>(std::clamp(at, 0.0, 0.999) * kSteps)].push_back(delay.ms);
    }
  const auto percentile = [](std::vector<double>& values, double share) {
    if (values.empty()) return Json();
    std::ranges::sort(values);
    const double value = values[static_cast<std::size_t>(share * double(values.size() - 1))];
    return Json(std::round(10 * value) / 10);
  };
  Json medians = Json::array();
  for (auto& step : steps) medians.push_back(percentile(step, 0.5));
  return {{"p50", percentile(all, 0.5)},
          {"p95", percentile(all, 0.95)},
          {"max", percentile(all, 1)},
          {"p50_of_each_twelfth", std::move(medians)}};
}

Json run(const Options& options) {
  const posevote::Dataset dataset = posevote::load_dataset(options.dataset);
  std::string folder = (fs::temp_directory_path() / "posevote-soak-XXXXXX").string();
  if (!mkdtemp(folder.data())) throw std::runtime_error("cannot make a temporary folder");
  Json report{{"clients", options.clients},
              {"seconds", options.seconds},
              {"objects", dataset.objects.size()}};
  {
    const Served server(folder);
    report["views"] = teach(server, dataset);
    Times times;
    std::atomic<bool> stop = false;
    const auto count = static_cast<std::size_t>(options.clients);
    std::vector<std::vector<Delay>> frames(count), results(count);
    std::vector<std::thread> threads;
    threads.emplace_back([&] { post_frames(server, dataset, options.fps, times, stop); });
    for (std::size_t i = 0; i < count; ++i)
      threads.emplace_back([&, i] {
        if (i % 2 == 0)
          watch(server, "/api/stream.mjpg", "X-Frame: ", times, frames[i], stop);
        else
          watch(server, "/api/events", "],\"frame\":", times, results[i], stop);
      });
    Json memory = Json::array();
    const auto begin = Clock::now();
    for (int i = 0; i <= kSteps; ++i) {
      const double due = i * options.seconds / kSteps;
      std::this_thread::sleep_for(std::chrono::duration<double>(due - seconds_since(begin)));
      memory.push_back(std::round(server.metric("process_resident_memory_bytes") / 1e5) / 10);
    }
    const double frames_total = server.metric("posevote_frames_total");
    report["memory_mb"] = memory;
    report["source_fps"] = frames_total / options.seconds;
    report["recognized_fps"] =
        server.metric("posevote_recognitions_total{of=\"live\"}") / options.seconds;
    report["frames_skipped"] = server.metric("posevote_frames_skipped_total");
    report["frames_missed_by_clients"] = server.metric("posevote_stream_frames_missed_total");
    stop = true;
    for (std::thread& thread : threads) thread.join();
    report["frame_delay_ms"] = summarize(frames, begin, options.seconds);
    report["result_delay_ms"] = summarize(results, begin, options.seconds);
  }
  fs::remove_all(folder);
  return report;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("Many clients watch a server for a long time");
  app.add_option("--clients", options.clients, "How many watch");
  app.add_option("--seconds", options.seconds, "How long");
  app.add_option("--fps", options.fps, "Pictures posted a second");
  app.add_option("--dataset", options.dataset,
                 "Folder with dataset.json: what is taught and shown");
  CLI11_PARSE(app, argc, argv);
  try {
    std::cout << run(options).dump(2) << '\n';
  } catch (const std::exception& error) {
    std::cerr << "bench_server_soak: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
