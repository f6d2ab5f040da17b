#include "posevote/feature/features.hpp"

#include <opencv2/imgproc.hpp>

#include "posevote/core/error.hpp"
#include "posevote/feature/sift_extractor.hpp"
#if POSEVOTE_WITH_SURF
#include "posevote/feature/surf/surf_extractor.hpp"
#endif

namespace posevote {

void SurfOptions::describe(OptionList& list) {
  list.add("hessian_threshold", hessian_threshold, {0, 1e9}, "",
           "Least determinant of the Hessian, on OpenCV's scale for 8-bit pictures.");
  list.add("octaves", octaves, {1, 8}, "", "Octaves of the scale space.");
  list.add("layers", layers, {1, 8}, "",
           "Layers per octave in which key points are looked for; two more filters enclose them.");
  list.add("upright", upright, "Leave out the orientation: for pictures that are never rotated.");
  list.add("smooth", smooth,
           "Filter the picture with a Gaussian of 1 px first: steadier features.");
  list.add("double_size", double_size,
           "Start on the picture enlarged by two: finds smaller things in four times the time.");
  list.add("spread", spread, "With max_features: take the strongest of every part of the picture.");
  list.add("threads", threads, {0, 64}, "", "Threads for one picture; 0 uses one per core.");
}

void SiftOptions::describe(OptionList& list) {
  list.add("layers", layers, {1, 8}, "", "Layers per octave.");
  list.add("contrast_threshold", contrast_threshold, {0, 1}, "",
           "Least contrast of a key point; smaller finds more.");
  list.add("edge_threshold", edge_threshold, {1, 1000}, "",
           "Largest ratio of the principal curvatures; larger keeps more points on edges.");
  list.add("sigma", sigma, {0.5, 10}, "px", "Smoothing of the first layer.");
}

void FeatureOptions::describe(OptionList& list) {
  list.add("kind", kind, {"surf", "sift"}, "Kind of features.");
  list.add("max_features", max_features, {0, 10'000'000}, "",
           "Keep this many of the strongest features of a picture; 0 keeps all.");
  list.add("more_in_large", more_in_large,
           "SURF: pictures of more than 2 megapixels may keep more features, in proportion.");
  list.add(
      "double_below_px", double_below_px, {0, 1e9}, "px",
      "SURF: pictures of fewer pixels are searched from one octave lower (enlarged by two); 0: "
      "none.");
  list.group("surf", surf);
  list.group("sift", sift);
}

std::string default_feature_kind() {
  return POSEVOTE_WITH_SURF ? "surf" : "sift";
}

std::string FeatureOptions::signature() const {
  if (kind == "sift") return "rootsift128 1";
  return surf.upright ? "surf64 upright 2" : "surf64 2";
}

std::shared_ptr<const Extractor> make_extractor(const FeatureOptions& options) {
  validate_options(options);
  if (options.kind == "sift") return make_sift_extractor(options);
#if POSEVOTE_WITH_SURF
  return make_surf_extractor(options, true);
#else
  throw Error(
      ErrorCode::unsupported,
      "this build of posevote has no SURF (POSEVOTE_WITH_SURF=OFF); use features of kind sift");
#endif
}

cv::Mat to_grey(const cv::Mat& image) {
  if (image.empty()) return {};
  if (image.dims != 2 || (image.depth() != CV_8U && image.depth() != CV_16U) ||
      (image.channels() != 1 && image.channels() != 3 && image.channels() != 4))
    throw Error(ErrorCode::invalid_argument,
                "a picture must have 8 or 16 bits and 1, 3 or 4 channels, not the type " +
                    cv::typeToString(image.type()));
  cv::Mat grey = image;
  if (image.channels() == 3) cv::cvtColor(image, grey, cv::COLOR_BGR2GRAY);
  if (image.channels() == 4) cv::cvtColor(image, grey, cv::COLOR_BGRA2GRAY);
  if (grey.depth() == CV_16U) grey.convertTo(grey, CV_8U, 1.0 / 256);
  return grey;
}

}  // namespace posevote
