#include "scale_peers.hpp"

#include <opencv2/features2d.hpp>
#include <opencv2/flann.hpp>
#if POSEVOTE_BENCH_FAISS
#include <faiss/IndexFlat.h>
#include <faiss/IndexIVFFlat.h>
#include <omp.h>
#endif
#if POSEVOTE_BENCH_HNSWLIB
#include <hnswlib/hnswlib.h>
#endif

namespace posevote::bench {
namespace {

class BruteForce : public Peer {
 public:
  explicit BruteForce(const cv::Mat& database) : database_(database) {}
  [[nodiscard]] cv::Mat search(const cv::Mat& queries, int k) const override {
    cv::Mat distances, indices;
    cv::batchDistance(queries, database_, distances, CV_32F, indices, cv::NORM_L2, k);
    return indices;
  }

 private:
  cv::Mat database_;
};

class Flann : public Peer {
 public:
  explicit Flann(const cv::Mat& database)
      : database_(database), index_(database_, cv::flann::KDTreeIndexParams(4)) {}
  [[nodiscard]] cv::Mat search(const cv::Mat& queries, int k) const override {
    cv::Mat distances, indices;
    index_.knnSearch(queries, indices, distances, k, cv::flann::SearchParams(32));
    return indices;
  }

 private:
  cv::Mat database_;
  mutable cv::flann::Index index_;
};

#if POSEVOTE_BENCH_FAISS
class Faiss : public Peer {
 public:
  Faiss(const cv::Mat& database, int lists, int probes) : flat_(database.cols) {
    omp_set_num_threads(1);
    if (lists > 0) {
      inverted_ = std::make_unique<faiss::IndexIVFFlat>(&flat_, database.cols, lists);
      inverted_->nprobe = static_cast<std::size_t>(probes);
      inverted_->train(database.rows, database.ptr<float>());
    }
    index().add(database.rows, database.ptr<float>());
  }
  [[nodiscard]] cv::Mat search(const cv::Mat& queries, int k) const override {
    std::vector<float> distances(queries.total());
    distances.resize(static_cast<std::size_t>(queries.rows * k));
    std::vector<faiss::Index::idx_t> found(distances.size());
    const_cast<Faiss*>(this)->index().search(queries.rows, queries.ptr<float>(), k,
                                             distances.data(), found.data());
    cv::Mat indices(queries.rows, k, CV_32S);
    std::copy(found.begin(), found.end(), indices.begin<int>());
    return indices;
  }

 private:
  faiss::Index& index() {
    return inverted_ ? static_cast<faiss::Index&>(*inverted_) : static_cast<faiss::Index&>(flat_);
  }

  faiss::IndexFlatL2 flat_;  ///< the database, or the coarse quantiser of `inverted_`
  std::unique_ptr<faiss::IndexIVFFlat> inverted_;
};
#endif

#if POSEVOTE_BENCH_HNSWLIB
class Hnsw : public Peer {
 public:
  Hnsw(const cv::Mat& database, std::size_t ef)
      : space_(static_cast<std::size_t>(database.cols)),
        graph_(&space_, static_cast<std::size_t>(database.rows), 16, 200) {
    for (int i = 0; i < database.rows; ++i)
      graph_.addPoint(database.ptr<float>(i), static_cast<std::size_t>(i));
    graph_.setEf(ef);
  }
  [[nodiscard]] cv::Mat search(const cv::Mat& queries, int k) const override {
    cv::Mat indices(queries.rows, k, CV_32S, cv::Scalar(-1));
    for (int q = 0; q < queries.rows; ++q) {
      auto found = graph_.searchKnn(queries.ptr<float>(q), static_cast<std::size_t>(k));
      for (; !found.empty(); found.pop())
        indices.at<int>(q, static_cast<int>(found.size()) - 1) =
            static_cast<int>(found.top().second);
    }
    return indices;
  }

 private:
  hnswlib::L2Space space_;
  hnswlib::HierarchicalNSW<float> graph_;
};
#endif

}  // namespace

std::vector<PeerKind> peer_kinds() {
  std::vector<PeerKind> kinds;
  const auto add = [&](const std::string& name, bool slow_search, bool slow_build, auto make) {
    kinds.push_back({name, slow_search, slow_build, make});
  };
  add("OpenCV brute force", true, false,
      [](const cv::Mat& d) { return std::make_unique<BruteForce>(d); });
  add("OpenCV FLANN (4 trees, 32 checks)", false, false,
      [](const cv::Mat& d) { return std::make_unique<Flann>(d); });
#if POSEVOTE_BENCH_FAISS
  add("FAISS flat", true, false, [](const cv::Mat& d) { return std::make_unique<Faiss>(d, 0, 0); });
  for (const int probes : {16, 64})
    add("FAISS IVF nprobe " + std::to_string(probes), false, true, [probes](const cv::Mat& d) {
      const int lists = static_cast<int>(4 * std::sqrt(double(d.rows)));
      return std::make_unique<Faiss>(d, lists, probes);
    });
#endif
#if POSEVOTE_BENCH_HNSWLIB
  for (const std::size_t ef : {32, 128})
    add("hnswlib M 16 ef " + std::to_string(ef), false, true,
        [ef](const cv::Mat& d) { return std::make_unique<Hnsw>(d, ef); });
#endif
  return kinds;
}

}  // namespace posevote::bench
