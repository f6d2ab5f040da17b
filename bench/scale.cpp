// How search time, recall, memory and preparation grow with the number of taught descriptors.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <set>

#include "perturb.hpp"
#include "posevote/index/index.hpp"
#include "scale_peers.hpp"
#include "scale_plot.hpp"

namespace {

using namespace posevote;
using bench::Peer;
using nlohmann::json;
using Rows = std::vector<std::vector<int>>;  ///< for each query rows of the database

struct Settings {
  std::vector<std::string> datasets;
  std::vector<int> sizes{10000, 100000, 1000000, 3600000};
  std::string kind = "surf";
  int queries = 1000, neighbors = 24, rounds = 5;
  int peers_up_to = 1000000, slow_peers_up_to = 100000;  ///< slow to build
  IndexOptions index;
};

/// What a search costs and finds, beside the exact answer.
struct Row {
  std::string method;
  int descriptors = 0;
  double us_per_query = 0, build_s = 0, load_s = 0, add_view_ms = 0, memory_mb = 0;
  double recall_first = 0, recall_matches = 0, recall_all = 0;
};

/// Processor time: other programs that run meanwhile hardly change it.
template <class Work>
double seconds(const Work& work) {
  const std::clock_t start = std::clock();
  work();
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double resident_mb() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.rfind("VmRSS:", 0) == 0) return std::stod(line.substr(6)) / 1024;
  return 0;
}

struct Pictures {
  std::vector<Features> views, scenes;
};

/// Features of all views (inside their masks) and of up to 60 test pictures of a dataset.
void read_dataset(const std::filesystem::path& folder, const Extractor& extractor,
                  Pictures& pictures) {
  const json dataset = json::parse(std::ifstream(folder / "dataset.json"));
  const auto extract = [&](const std::string& image, const std::string& mask) {
    const cv::Mat picture = cv::imread((folder / image).string());
    cv::Mat area;
    if (!mask.empty()) area = cv::imread((folder / mask).string(), cv::IMREAD_GRAYSCALE);
    return extractor.extract(picture, area);
  };
  for (const json& object : dataset.value("objects", json::array()))
    for (const json& view : object["views"])
      pictures.views.push_back(extract(view["image"].get<std::string>(),
                                       view.value("mask", view.value("truth_mask", ""))));
  const json tests = dataset.value("tests", json::array());
  const std::size_t stride = std::max<std::size_t>(1, tests.size() / 60);
  for (std::size_t i = 0; i < tests.size(); i += stride)
    pictures.scenes.push_back(extract(tests[i]["image"].get<std::string>(), ""));
}

std::shared_ptr<const View> make_view(Features features) {
  auto view = std::make_shared<View>();
  view->outline = {{0, 0}, {1, 0}, {1, 1}};
  view->features = std::move(features);
  return view;
}

/// `size` descriptors: views of the pictures, evenly chosen, then perturbed ones.
std::vector<std::shared_ptr<const View>> make_views(const Pictures& pictures, int size) {
  std::size_t real = 0;
  for (const Features& view : pictures.views) real += view.size();
  const std::size_t stride = std::max<std::size_t>(1, real / static_cast<std::size_t>(size));
  cv::RNG random(1);
  std::vector<std::shared_ptr<const View>> views;
  int left = size;
  for (std::size_t i = 0; left > 0; ++i) {
    const std::size_t place = i * stride;
    const Features& source = pictures.views[place % pictures.views.size()];
    Features features = place < pictures.views.size() ? source : bench::perturbed(source, random);
    const int count = std::min(left, static_cast<int>(features.size()));
    if (count == 0) continue;
    features.keypoints.resize(static_cast<std::size_t>(count));
    features.descriptors = features.descriptors.rowRange(0, count).clone();
    views.push_back(make_view(std::move(features)));
    left -= count;
  }
  return views;
}

std::shared_ptr<const ModelSet> make_models(const std::vector<std::shared_ptr<const View>>& views) {
  std::vector<ObjectModel> objects;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (i % 12 == 0) objects.push_back({"object " + std::to_string(i / 12), {}});
    objects.back().views.push_back(views[i]);
  }
  return std::make_shared<ModelSet>("bench", std::move(objects));
}

Features choose_queries(const std::vector<Features>& scenes, int count) {
  std::size_t all = 0;
  for (const Features& scene : scenes) all += scene.size();
  const double step = std::max(1.0, static_cast<double>(all) / count);
  Features result;
  double next = 0;
  std::size_t seen = 0;
  for (const Features& scene : scenes)
    for (std::size_t i = 0; i < scene.size(); ++i, ++seen) {
      if (static_cast<double>(seen) < next) continue;
      next += step;
      result.keypoints.push_back(scene.keypoints[i]);
      result.descriptors.push_back(scene.descriptors.row(static_cast<int>(i)));
    }
  return result;
}

/// The database of one size and the exact answers.
struct Problem {
  std::shared_ptr<const ModelSet> models;
  std::vector<int> first;  ///< row of each view's first descriptor
  cv::Mat rows;            ///< all descriptors; only for the other libraries
  Features queries;
  NeighborLists exact;
  int descriptors = 0;

  [[nodiscard]] Rows to_rows(const NeighborLists& found) const {
    Rows result(found.size());
    for (std::size_t q = 0; q < found.size(); ++q)
      for (const Neighbor& n : found[q])
        result[q].push_back(first[static_cast<std::size_t>(n.view)] + n.feature);
    return result;
  }
  /// Is the first neighbour clearly nearer than the nearest of another object?
  [[nodiscard]] bool matches(std::size_t q) const {
    const auto object = [&](const Neighbor& n) {
      return models->views()[static_cast<std::size_t>(n.view)].object;
    };
    for (const Neighbor& n : exact[q])
      if (object(n) != object(exact[q][0])) return exact[q][0].distance < 0.8F * n.distance;
    return !exact[q].empty();
  }
};

void score(const Problem& problem, const Rows& found, const Rows& truth, Row& row) {
  double first = 0, matched = 0, matches = 0, all = 0, wanted = 0;
  for (std::size_t q = 0; q < found.size(); ++q) {
    if (truth[q].empty()) continue;
    const bool same = !found[q].empty() && found[q][0] == truth[q][0];
    first += same;
    if (problem.matches(q)) ++matches;
    if (problem.matches(q)) matched += same;
    const std::set<int> unique(found[q].begin(), found[q].end());
    for (const int t : truth[q]) all += static_cast<double>(unique.count(t));
    wanted += static_cast<double>(truth[q].size());
  }
  row.recall_first = first / static_cast<double>(found.size());
  row.recall_matches = matches > 0 ? matched / matches : 1;
  row.recall_all = wanted > 0 ? all / wanted : 1;
}

/// One search to be timed in turn with the others.
struct Contestant {
  Row row;
  std::function<Rows()> search;
  std::size_t queries;
  int rounds;
  std::vector<double> times;
};

Contestant ours(const Settings& settings, const Problem& problem, const std::string& method) {
  Contestant result;
  result.row.method = "posevote " + method;
  IndexOptions options = settings.index;
  options.method = method;
  std::shared_ptr<const Index> index;
  result.row.build_s = seconds([&] { index = make_index(problem.models, options); });
  const std::string saved = index->save();
  result.row.load_s = seconds([&] { (void)load_index(problem.models, saved, options); });
  auto views = std::vector<std::shared_ptr<const View>>();
  for (const auto& entry : problem.models->views()) views.push_back(entry.view);
  cv::RNG random(2);
  views.push_back(make_view(bench::perturbed(views.front()->features, random)));
  const auto grown = make_models(views);
  result.row.add_view_ms = 1e3 * seconds([&] { (void)make_index(grown, options, index.get()); });
  result.row.memory_mb = static_cast<double>(index->statistics().bytes) / (1 << 20);
  result.queries = problem.queries.size();
  result.rounds = method == "exact" && problem.descriptors > 200000 ? 1 : settings.rounds;
  result.search = [&problem, index, k = settings.neighbors] {
    return problem.to_rows(index->search(problem.queries, k));
  };
  return result;
}

Contestant theirs(const Settings& settings, const Problem& problem, const bench::PeerKind& kind) {
  Contestant result;
  result.row.method = kind.name;
  const double before = resident_mb();
  std::shared_ptr<const Peer> peer;
  result.row.build_s = seconds([&] { peer = kind.make(problem.rows); });
  result.row.memory_mb = resident_mb() - before;
  const int count = kind.slow_search ? 100 : static_cast<int>(problem.queries.size());
  const cv::Mat queries =
      problem.queries.descriptors.rowRange(0, std::min(count, problem.queries.descriptors.rows));
  result.queries = static_cast<std::size_t>(queries.rows);
  result.rounds = settings.rounds;
  result.search = [peer, queries, k = settings.neighbors] {
    const cv::Mat found = peer->search(queries, k);
    Rows rows(static_cast<std::size_t>(found.rows));
    for (int q = 0; q < found.rows; ++q)
      rows[static_cast<std::size_t>(q)].assign(found.ptr<int>(q), found.ptr<int>(q) + found.cols);
    return rows;
  };
  return result;
}

/// The other libraries do not know signs: they are scored by the plain neighbours.
Rows plain_truth(const Settings& settings, const Problem& problem) {
  IndexOptions options = settings.index;
  options.method = "exact";
  Features unsigned_queries = problem.queries;
  for (Keypoint& keypoint : unsigned_queries.keypoints) keypoint.laplacian = 0;
  return problem.to_rows(
      make_index(problem.models, options)->search(unsigned_queries, settings.neighbors));
}

std::vector<Row> compare(const Settings& settings, const Problem& problem) {
  std::vector<Contestant> contestants;
  for (const char* method : {"exact", "approximate"})
    contestants.push_back(ours(settings, problem, method));
  const std::size_t own = contestants.size();
  Rows truth = problem.to_rows(problem.exact), plain;
  if (problem.descriptors <= settings.peers_up_to) {
    plain = plain_truth(settings, problem);
    for (const auto& kind : bench::peer_kinds())
      if (!kind.slow_build || problem.descriptors <= settings.slow_peers_up_to)
        contestants.push_back(theirs(settings, problem, kind));
  }
  for (int round = 0; round < settings.rounds; ++round)
    for (std::size_t c = 0; c < contestants.size(); ++c) {
      if (round >= contestants[c].rounds) continue;
      Rows found;
      const double time = seconds([&] { found = contestants[c].search(); });
      contestants[c].times.push_back(1e6 * time / static_cast<double>(contestants[c].queries));
      if (round == 0) score(problem, found, c < own ? truth : plain, contestants[c].row);
    }
  std::vector<Row> rows;
  for (Contestant& contestant : contestants) {
    contestant.row.us_per_query = median(contestant.times);
    contestant.row.descriptors = problem.descriptors;
    rows.push_back(contestant.row);
  }
  return rows;
}

Problem make_problem(const Settings& settings, const Pictures& pictures, int size) {
  Problem problem;
  const auto views = make_views(pictures, size);
  problem.models = make_models(views);
  problem.descriptors = size;
  int next = 0;
  for (const auto& view : views) {
    problem.first.push_back(next);
    next += static_cast<int>(view->features.size());
  }
  if (size <= settings.peers_up_to) {
    std::vector<cv::Mat> parts;
    parts.reserve(views.size());
    for (const auto& view : views) parts.push_back(view->features.descriptors);
    cv::vconcat(parts, problem.rows);
  }
  problem.queries = choose_queries(pictures.scenes, settings.queries);
  IndexOptions options = settings.index;
  options.method = "exact";
  problem.exact = make_index(problem.models, options)->search(problem.queries, settings.neighbors);
  return problem;
}

void print(const Row& row) {
  std::printf("| %8d | %-34s | %9.1f | %6.3f | %6.3f | %6.3f | %8.2f | %6.2f | %7.1f | %7.1f |\n",
              row.descriptors, row.method.c_str(), row.us_per_query, row.recall_first,
              row.recall_matches, row.recall_all, row.build_s, row.load_s, row.add_view_ms,
              row.memory_mb);
  std::fflush(stdout);
}

json to_json(const Row& row) {
  return {{"descriptors", row.descriptors},
          {"method", row.method},
          {"us_per_query", row.us_per_query},
          {"recall_first", row.recall_first},
          {"recall_matches", row.recall_matches},
          {"recall_all", row.recall_all},
          {"build_s", row.build_s},
          {"load_s", row.load_s},
          {"add_view_ms", row.add_view_ms},
          {"memory_mb", row.memory_mb}};
}

std::string draw(const std::vector<Row>& rows) {
  const auto panel = [&](const std::string& title, auto value) {
    bench::Panel result{title, {}};
    for (const Row& row : rows) {
      auto curve = std::find_if(result.curves.begin(), result.curves.end(),
                                [&](const auto& c) { return c.name == row.method; });
      if (curve == result.curves.end())
        curve = result.curves.insert(curve, bench::Curve{row.method, {}});
      if (value(row) > 0) curve->points.emplace_back(row.descriptors, value(row));
    }
    return result;
  };
  return bench::plot_svg(
      "taught descriptors",
      {panel("time of a query, us", [](const Row& row) { return row.us_per_query; }),
       panel("memory beside the features, MB", [](const Row& row) { return row.memory_mb; })});
}

int run(const Settings& settings, const std::string& json_file, const std::string& svg_file) {
  FeatureOptions feature;
  feature.kind = settings.kind;
  const auto extractor = make_extractor(feature);
  Pictures pictures;
  for (const std::string& dataset : settings.datasets) read_dataset(dataset, *extractor, pictures);
  std::size_t real = 0;
  for (const Features& view : pictures.views) real += view.size();
  std::printf("%zu descriptors of pictures, %d queries, %d neighbours, medians of %d rounds\n\n",
              real, settings.queries, settings.neighbors, settings.rounds);
  std::printf(
      "| taught | search | us/query | 1st | matches | all k | build s | load s | "
      "add view ms | MB |\n|---:|---|---:|---:|---:|---:|---:|---:|---:|---:|\n");
  std::vector<Row> rows;
  json report = json::array();
  for (const int size : settings.sizes) {
    const Problem problem = make_problem(settings, pictures, size);
    for (const Row& row : compare(settings, problem)) {
      print(row);
      rows.push_back(row);
      report.push_back(to_json(row));
    }
  }
  if (!json_file.empty()) std::ofstream(json_file) << report.dump(2) << '\n';
  if (!svg_file.empty()) std::ofstream(svg_file) << draw(rows);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Settings settings;
  std::string json_file, svg_file;
  CLI::App app("Search time, recall, memory and preparation by number of taught descriptors.");
  settings.datasets = {POSEVOTE_SOURCE_DIR "/data/demo"};
  app.add_option("--dataset", settings.datasets, "Folders with dataset.json")
      ->capture_default_str();
  app.add_option("--sizes", settings.sizes, "Numbers of taught descriptors")->delimiter(',');
  app.add_option("--features", settings.kind, "surf or sift");
  app.add_option("--queries", settings.queries, "Scene features");
  app.add_option("--neighbors", settings.neighbors, "k");
  app.add_option("--rounds", settings.rounds, "Repetitions");
  app.add_option("--probes", settings.index.probes, "Lists looked through");
  app.add_option("--threads", settings.index.threads, "Threads of our search");
  app.add_option("--peers-up-to", settings.peers_up_to, "Other libraries up to this size");
  app.add_option("--slow-peers-up-to", settings.slow_peers_up_to,
                 "Those that are slow to build up to this size");
  app.add_option("--svg", svg_file, "Draw the results in this file");
  app.add_option("--json", json_file, "Write the results to this file");
  CLI11_PARSE(app, argc, argv);
  try {
    return run(settings, json_file, svg_file);
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
