// Teaches an object by background difference into a database, recognises it in a scene, draws it.
//   teach_and_recognize DATABASE NAME PICTURE BACKGROUND SCENE DRAWN
#include <cstdio>
#include <opencv2/imgcodecs.hpp>
#include <posevote/core/error.hpp>
#include <posevote/image/read_image.hpp>
#include <posevote/recognize/recognizer.hpp>
#include <posevote/render/annotate.hpp>
#include <posevote/store/sqlite/sqlite_store.hpp>
#include <posevote/teach/teacher.hpp>

int main(int argc, char** argv) try {
  if (argc != 7) return std::fprintf(stderr, "six arguments, please: see the source\n"), 2;
  const posevote::RecognizeOptions options;

  posevote::TaughtView taught;
  taught.picture = posevote::read_bytes(argv[3]);
  posevote::ViewSource source;
  source.picture = posevote::decode_image(taught.picture, argv[3]);
  source.background = posevote::read_image(argv[4]);
  posevote::TeachOptions teach;
  teach.feature = options.feature;
  taught.view = posevote::teach_view(source, teach);
  taught.method = "background";

  const auto store = posevote::open_sqlite_store(argv[1]);
  store->add_view(argv[2], taught, posevote::record_features(options.feature));

  const posevote::Recognizer recognizer(store->load(), options);
  const cv::Mat scene = posevote::read_image(argv[5]);
  const posevote::RecognitionResult result = recognizer.recognize(scene);
  for (const posevote::Detection& found : result.detections)
    std::printf("%s: confidence %.2f, %d inliers, at (%.0f, %.0f)\n", found.object.c_str(),
                found.confidence, found.inliers, found.box.x, found.box.y);
  cv::imwrite(argv[6], posevote::annotate(scene, result));
  return result.detections.empty() ? 1 : 0;
} catch (const posevote::Error& error) {
  return std::fprintf(stderr, "%s\n", error.what()), 1;
}
