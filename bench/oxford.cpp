// bench_oxford [FOLDER] [--features N] [--shrink F] [--ours] [OPTION=VALUE ...]
//
// How well features are found again on the sequences of Mikolajczyk et al. (IJCV 65, 2005), for our
// SURF, dlib's SURF and OpenCV's SIFT (plain and as RootSIFT), with N key points per picture
// (1000). OPTION=VALUE are feature options of ours, e.g. surf.octaves=3. Per pair and method:
//   repeatability   corresponding regions (overlap error <= 40 %, reference region scaled to radius
//                   30, one to one) over the smaller number of key points in the part seen in both
//   matching score  of those, the ones that are mutual nearest neighbours of each other
//   correct         mutual nearest neighbours at most 3 px from where the homography says
#include <dlib/image_keypoint.h>
#include <dlib/opencv.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <opencv2/features2d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>

#include "posevote/core/error.hpp"
#include "posevote/feature/features.hpp"
#include "posevote/feature/surf/surf_extractor.hpp"

namespace {

using posevote::Features;
using posevote::Keypoint;

struct Method {
  std::string name;
  std::function<Features(const cv::Mat&)> extract;
};

struct Score {
  double repeatability = 0, matching = 0, correct = 0;
};

Features features_of_dlib(const cv::Mat& grey, int count) {
  Features features;
  const auto points = dlib::get_surf_points(dlib::cv_image<unsigned char>(grey), count, 1);
  for (const auto& point : points) {
    Keypoint keypoint;
    keypoint.x = static_cast<float>(point.p.center.x());
    keypoint.y = static_cast<float>(point.p.center.y());
    keypoint.scale = static_cast<float>(point.p.scale);
    keypoint.laplacian = point.p.laplacian > 0 ? 1 : -1;
    features.keypoints.push_back(keypoint);
    cv::Mat row(1, 64, CV_32F);
    for (int i = 0; i < 64; ++i) row.at<float>(i) = static_cast<float>(point.des(i));
    features.descriptors.push_back(row);
  }
  return features;
}

Features features_of_sift(const cv::Mat& grey, int count) {
  std::vector<cv::KeyPoint> points;
  Features features;
  cv::SIFT::create(count)->detectAndCompute(grey, {}, points, features.descriptors);
  for (const auto& point : points) {
    Keypoint keypoint;
    keypoint.x = point.pt.x;
    keypoint.y = point.pt.y;
    keypoint.scale = point.size / 2;
    features.keypoints.push_back(keypoint);
  }
  return features;
}

cv::Point2d map_point(const cv::Matx33d& h, const cv::Point2d& p) {
  const cv::Vec3d q = h * cv::Vec3d(p.x, p.y, 1);
  return {q[0] / q[2], q[1] / q[2]};
}

// Derivative of the homography at p.
cv::Matx22d local_affine(const cv::Matx33d& h, const cv::Point2d& p) {
  const cv::Vec3d q = h * cv::Vec3d(p.x, p.y, 1);
  cv::Matx22d a;
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j) a(i, j) = (h(i, j) - q[i] / q[2] * h(2, j)) / q[2];
  return a;
}

// 1 - intersection / union of the ellipse {A u, |u| <= 1} at 0 and the circle of radius r at c.
double overlap_error(const cv::Matx22d& a, const cv::Point2d& c, double r) {
  const cv::Matx22d inverse = a.inv();
  const double reach = std::max(cv::norm(a), r) + std::hypot(c.x, c.y);
  constexpr int kSteps = 40;
  int both = 0, either = 0;
  for (int j = 0; j < kSteps; ++j)
    for (int i = 0; i < kSteps; ++i) {
      const double x = reach * (2 * (i + 0.5) / kSteps - 1);
      const double y = reach * (2 * (j + 0.5) / kSteps - 1);
      const cv::Vec2d u = inverse * cv::Vec2d(x, y);
      const bool in_a = u.dot(u) <= 1;
      const bool in_b = (x - c.x) * (x - c.x) + (y - c.y) * (y - c.y) <= r * r;
      both += in_a && in_b;
      either += in_a || in_b;
    }
  return either ? 1 - static_cast<double>(both) / either : 1;
}

cv::Point2d point_of(const Keypoint& k) {
  return {k.x, k.y};
}

std::vector<int> inside(const Features& features, const cv::Matx33d& h, cv::Size size) {
  std::vector<int> kept;
  for (int i = 0; i < static_cast<int>(features.size()); ++i) {
    const cv::Point2d p = map_point(h, point_of(features.keypoints[i]));
    if (p.x >= 0 && p.y >= 0 && p.x <= size.width - 1 && p.y <= size.height - 1) kept.push_back(i);
  }
  return kept;
}

struct Pair {
  int from, to;
  double cost;
};

// One to one, cheapest first.
std::vector<Pair> one_to_one(std::vector<Pair> pairs, std::size_t from_count,
                             std::size_t to_count) {
  std::ranges::stable_sort(pairs, {}, &Pair::cost);
  std::vector<char> from_used(from_count), to_used(to_count);
  std::erase_if(pairs, [&](const Pair& pair) {
    if (from_used[pair.from] || to_used[pair.to]) return true;
    return !(from_used[pair.from] = to_used[pair.to] = 1);
  });
  return pairs;
}

std::vector<Pair> region_pairs(const Features& one, const Features& two, const cv::Matx33d& h,
                               const std::vector<int>& from, const std::vector<int>& to) {
  std::vector<Pair> pairs;
  for (const int i : from) {
    const Keypoint& p = one.keypoints[i];
    const cv::Point2d at = map_point(h, point_of(p));
    const double zoom = 30.0 / p.scale;  // the reference region has radius 30
    const cv::Matx22d region = local_affine(h, point_of(p)) * 30.0;
    const double mean_radius = std::sqrt(std::abs(cv::determinant(region)));
    for (const int j : to) {
      const Keypoint& q = two.keypoints[j];
      const double radius = q.scale * zoom, ratio = radius / mean_radius;
      const cv::Point2d off = point_of(q) - at;
      if (std::hypot(off.x, off.y) > mean_radius || ratio > 1.7 || ratio < 1 / 1.7) continue;
      const double error = overlap_error(region, off, radius);
      if (error <= 0.4) pairs.push_back({i, j, error});
    }
  }
  return one_to_one(pairs, one.size(), two.size());
}

// Mutual nearest neighbours; features of opposite Laplacian sign are not compared.
std::vector<Pair> descriptor_pairs(const Features& one, const Features& two) {
  std::vector<Pair> pairs;
  if (one.empty() || two.empty()) return pairs;
  cv::Mat dot = one.descriptors * two.descriptors.t(), length_one, length_two;
  cv::reduce(one.descriptors.mul(one.descriptors), length_one, 1, cv::REDUCE_SUM);
  cv::reduce(two.descriptors.mul(two.descriptors), length_two, 1, cv::REDUCE_SUM);
  std::vector<int> nearest(two.size(), -1);
  std::vector<float> least(two.size(), 1e30F);
  for (int i = 0; i < dot.rows; ++i) {
    Pair best{i, -1, 1e30};
    for (int j = 0; j < dot.cols; ++j) {
      if (one.keypoints[i].laplacian * two.keypoints[j].laplacian < 0) continue;
      const float distance =
          length_one.at<float>(i) + length_two.at<float>(j) - 2 * dot.at<float>(i, j);
      if (distance < best.cost) best = {i, j, distance};
      if (distance < least[j]) least[j] = distance, nearest[j] = i;
    }
    if (best.to >= 0) pairs.push_back(best);
  }
  std::erase_if(pairs, [&](const Pair& pair) { return nearest[pair.to] != pair.from; });
  return pairs;
}

Score score_pair(const Features& one, const Features& two, const cv::Matx33d& h, cv::Size size_one,
                 cv::Size size_two) {
  const auto from = inside(one, h, size_two), to = inside(two, h.inv(), size_one);
  const auto regions = region_pairs(one, two, h, from, to);
  const double count =
      static_cast<double>(std::max<std::size_t>(1, std::min(from.size(), to.size())));
  std::vector<int> region_of(one.size(), -1);
  for (const Pair& pair : regions) region_of[pair.from] = pair.to;
  Score score;
  score.repeatability = static_cast<double>(regions.size()) / count;
  for (const Pair& pair : descriptor_pairs(one, two)) {
    const cv::Point2d off =
        map_point(h, point_of(one.keypoints[pair.from])) - point_of(two.keypoints[pair.to]);
    score.correct += std::hypot(off.x, off.y) <= 3;
    score.matching += region_of[pair.from] == pair.to ? 1 / count : 0;
  }
  return score;
}

cv::Matx33d read_homography(const std::filesystem::path& file) {
  std::ifstream in(file);
  cv::Matx33d h;
  for (double& value : h.val)
    if (!(in >> value)) throw std::runtime_error(file.string() + " has no 3x3 matrix");
  return h;
}

cv::Mat read_grey(const std::filesystem::path& file) {
  cv::Mat grey = cv::imread(file.string(), cv::IMREAD_GRAYSCALE);
  if (grey.empty()) throw std::runtime_error("cannot read " + file.string());
  return grey;
}

void print_row(const std::string& name, const std::vector<Score>& scores) {
  std::printf("%-10s", name.c_str());
  for (const Score& score : scores)
    std::printf("  | %5.1f %5.1f %6.1f", 100 * score.repeatability, 100 * score.matching,
                score.correct);
  std::printf("\n");
}

// The picture reduced to `factor`, and the homography into it.
void shrink(double factor, cv::Mat& picture, cv::Matx33d& h) {
  if (factor == 1) return;
  cv::resize(picture, picture, {}, factor, factor, cv::INTER_AREA);
  const double shift = (factor - 1) / 2;  // pixel centres
  h = cv::Matx33d(factor, 0, shift, 0, factor, shift, 0, 0, 1) * h;
}

void print_ratios(const std::vector<Score>& scores, const Score& dlib) {
  std::printf("%-10s", "/ dlib");
  for (const Score& score : scores)
    std::printf("  | %5.2f %5.2f %6.2f", score.repeatability / dlib.repeatability,
                score.matching / dlib.matching, score.correct / dlib.correct);
  std::printf("\n");
}

void run(const std::filesystem::path& folder, double factor, const std::vector<Method>& methods) {
  std::printf("per method: repeatability %%, matching score %%, correct matches (<= 3 px)\n%-10s",
              "pair");
  for (const Method& method : methods) std::printf("  | %-18s", method.name.c_str());
  std::printf("\n");
  std::vector<Score> sums(methods.size());
  int pairs = 0;
  for (const char* name : {"bark", "bikes", "boat", "graf", "leuven", "trees", "ubc", "wall"}) {
    const auto sequence = folder / name;
    const cv::Mat first = read_grey(sequence / "img1.png");
    std::vector<Features> reference;
    reference.reserve(methods.size());
    for (const Method& method : methods) reference.push_back(method.extract(first));
    for (int n = 2; n <= 6; ++n) {
      cv::Mat other = read_grey(sequence / ("img" + std::to_string(n) + ".png"));
      cv::Matx33d h = read_homography(sequence / ("H1to" + std::to_string(n) + "p.txt"));
      shrink(factor, other, h);
      std::vector<Score> row;
      for (std::size_t m = 0; m < methods.size(); ++m) {
        row.push_back(
            score_pair(reference[m], methods[m].extract(other), h, first.size(), other.size()));
        sums[m].repeatability += row[m].repeatability;
        sums[m].matching += row[m].matching;
        sums[m].correct += row[m].correct;
      }
      print_row(std::string(name) + " 1-" + std::to_string(n), row);
      ++pairs;
    }
  }
  for (Score& sum : sums)
    sum = {sum.repeatability / pairs, sum.matching / pairs, sum.correct / pairs};
  print_row("mean", sums);
  if (methods.size() > 1) print_ratios(sums, sums[1]);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    std::filesystem::path folder = "../shared/data/oxford-affine";
    int count = 1000;
    double factor = 1;
    bool only_ours = false;
    posevote::FeatureOptions ours;
    ours.surf.hessian_threshold = 1;  // let the number of key points decide, as for the others
    for (int i = 1; i < argc; ++i) {
      const std::string argument = argv[i];
      const auto equals = argument.find('=');
      if (argument == "--features" && i + 1 < argc)
        count = std::stoi(argv[++i]);
      else if (argument == "--shrink" && i + 1 < argc)
        factor = std::stod(argv[++i]);
      else if (argument == "--ours")
        only_ours = true;
      else if (equals != std::string::npos)
        posevote::list_options(ours).set(argument.substr(0, equals), argument.substr(equals + 1));
      else
        folder = argument;
    }
    ours.max_features = count;
    const auto surf = posevote::make_surf_extractor(ours);
    posevote::FeatureOptions root_options;
    root_options.kind = "sift";
    root_options.max_features = count;
    const auto root_sift = posevote::make_extractor(root_options);
    std::vector<Method> methods{
        {"posevote surf", [&](const cv::Mat& grey) { return surf->extract(grey); }},
        {"dlib surf", [&](const cv::Mat& grey) { return features_of_dlib(grey, count); }},
        {"OpenCV sift", [&](const cv::Mat& grey) { return features_of_sift(grey, count); }},
        {"posevote sift", [&](const cv::Mat& grey) { return root_sift->extract(grey); }}};
    if (only_ours) methods.resize(1);
    run(folder, factor, methods);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_oxford: %s\n", error.what());
    return 1;
  }
  return 0;
}
