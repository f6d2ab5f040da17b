#include "posevote/evaluate/report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <fstream>

#include "posevote/core/error.hpp"
#include "posevote/evaluate/cases.hpp"
#include "posevote/evaluate/made_dataset.hpp"
#include "posevote/evaluate/method.hpp"

namespace posevote {
namespace {

using testing::HasSubstr;
using testing::Not;

int count(const std::string& text, const std::string& part) {
  int found = 0;
  for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; at += part.size())
    ++found;
  return found;
}

// Pictures with a right answer, a false one and a miss each.
Evaluation evaluate_made(const MadeDataset& made) {
  Evaluation evaluation;
  evaluation.dataset = load_dataset(made.folder());
  const auto answer = [](const cv::Mat& picture) {
    RecognitionResult result;
    result.image_size = picture.size();
    Detection wrong;
    wrong.object = "cover-1 <b>";
    wrong.outline = {{300, 10}, {340, 10}, {340, 60}};
    wrong.box = {300, 10, 40, 50};
    wrong.log10_false_alarms = -3;
    result.detections = {wrong};
    return result;
  };
  evaluation.outcomes = run_tests(evaluation.dataset, answer, 1);
  return evaluation;
}

MadeDataset& made_two() {
  static MadeDataset made(2);
  if (made.document()["tests"].empty()) {
    made.add_test("easy", 0);
    made.add_test("hard", 1);
  }
  return made;
}

TEST(Cases, ComeWorstFirst) {
  Evaluation evaluation = evaluate_made(made_two());
  evaluation.outcomes[1].result.detections[0].log10_false_alarms = -9;
  evaluation.dataset.tests[0].objects[0].visible = 0.3;
  const auto wrong = cases_of(evaluation.dataset, evaluation.outcomes, Verdict::false_positive);
  ASSERT_EQ(wrong.size(), 2U);
  EXPECT_EQ(wrong[0].outcome->test, 1U);
  const auto missed = missed_cases(evaluation.dataset, evaluation.outcomes);
  ASSERT_EQ(missed.size(), 2U);
  EXPECT_EQ(missed[0].outcome->test, 1U);
}

TEST(CaseFigure, OfAPictureThatIsGoneIsLeftOut) {
  Evaluation evaluation = evaluate_made(made_two());
  evaluation.dataset.tests[0].image = "gone.png";
  const auto missed = missed_cases(evaluation.dataset, evaluation.outcomes);
  EXPECT_EQ(case_figure(missed[0], nullptr, {}), "");
}

TEST(JpegDataUrl, HoldsTheWholePicture) {
  const std::string url = jpeg_data_url(draw_cover(3), 90);
  ASSERT_THAT(url, testing::StartsWith("data:image/jpeg;base64,/9j/"));
  EXPECT_EQ((url.size() - 23) % 4, 0U);
}

TEST(MakeReport, IsOnePageThatNeedsNothingElse) {
  const std::string html = make_report({evaluate_made(made_two())});
  EXPECT_EQ(count(html, "<figure>"), 4);
  EXPECT_EQ(count(html, "src=\"data:image/jpeg;base64,"), 4);
  EXPECT_THAT(html, Not(HasSubstr("http")));
  EXPECT_THAT(html, Not(HasSubstr("<script")));
  EXPECT_THAT(html, HasSubstr("cover-1 &lt;b&gt;"));
  EXPECT_THAT(html, Not(HasSubstr("cover-1 <b>")));
  EXPECT_EQ(make_report({evaluate_made(made_two())}), html);
}

// A right answer, a missed object with what `explain` says, a taught silhouette.
Evaluation evaluate_explained(MadeDataset& made) {
  made.teach_first_by_background();
  made.add_test("found", 0);
  made.add_test("missed", -1, {{"objects", {{{"name", "cover-1"}, {"box", {100, 50, 160, 160}}}}}});
  const Dataset dataset = load_dataset(made.folder());
  const TaughtMethod taught(dataset, make_method("default", {}));
  Evaluation evaluation = taught.evaluate(dataset);
  taught.explain_worst(evaluation, 5);
  return evaluation;
}

TEST(MakeReport, SaysOfEachWorstCaseWhatExplainSays) {
  MadeDataset made(2);
  const std::string html = make_report({evaluate_explained(made)});
  EXPECT_EQ(count(html, "<details>"), 1);
  EXPECT_THAT(html, HasSubstr("<summary>Not found: nothing in the picture has texture enough"));
  EXPECT_THAT(html, HasSubstr("<td>features of the picture</td><td>0</td>"));
  EXPECT_THAT(html, HasSubstr("<code>feature.surf.hessian_threshold</code>"));
}

TEST(MakeReport, ShowsTheSilhouettesThatWereTaught) {
  MadeDataset made(2);
  const std::string html = make_report({evaluate_explained(made)});
  EXPECT_THAT(html, HasSubstr("Taught silhouettes"));
  EXPECT_THAT(html, HasSubstr("<b>cover-0</b> IoU "));
  EXPECT_EQ(count(html, "<figure>"), 2) << "the silhouette and the missed object";
}

TEST(MakeReport, ShowsNoMorePicturesThanAskedFor) {
  ReportOptions options;
  options.max_cases = 1;
  const std::string html = make_report({evaluate_made(made_two())}, {}, options);
  EXPECT_EQ(count(html, "<figure>"), 2);
  EXPECT_THAT(html, HasSubstr("(2, the first 1 shown)"));
}

TEST(MakeReport, TakesSectionsAndSeveralSets) {
  ReportSection section{"Robustness", "Words.", {}, {}};
  section.tables.emplace_back();
  section.tables[0].header = {"level"};
  section.tables[0].rows = {{"3"}};
  const Evaluation evaluation = evaluate_made(made_two());
  const std::string html = make_report({evaluation, evaluation}, {section});
  EXPECT_THAT(html, HasSubstr("<h2>Robustness</h2>"));
  EXPECT_THAT(html, HasSubstr("href=\"#set1\""));
  const std::string markdown = make_markdown({evaluation}, {section});
  EXPECT_THAT(markdown, HasSubstr("## Robustness"));
  EXPECT_THAT(markdown, HasSubstr("| easy | 1 | 1 |"));
  EXPECT_THAT(to_json(section), HasSubstr("\"rows\":[[\"3\"]]"));
}

TEST(WriteReport, SaysWhenItCannot) {
  const TemporaryFolder folder;
  EXPECT_TRUE(std::filesystem::exists(write_report("<p>", folder.path() / "new")));
  std::ofstream(folder.path() / "file") << "x";
  EXPECT_THROW(write_report("<p>", folder.path() / "file"), Error);
}

// Runs a browser without a window and gives the page as it stands after its scripts ran.
std::string open_in_browser(const std::filesystem::path& page, const std::filesystem::path& home) {
  const std::string command = "HOME='" + home.string() +
                              "' chromium --headless --no-sandbox --disable-gpu " +
                              "--user-data-dir='" + (home / "profile").string() +
                              "' --dump-dom 'file://" + page.string() + "' 2>/dev/null";
  std::FILE* pipe = popen(command.c_str(), "r");
  std::string text;
  std::array<char, 4096> buffer{};
  for (std::size_t n = 0; (n = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;)
    text.append(buffer.data(), n);
  pclose(pipe);
  return text;
}

TEST(MakeReport, LoadsEveryPictureInABrowser) {
  if (std::system("command -v chromium >/dev/null") != 0) GTEST_SKIP() << "chromium is not here";
  MadeDataset made(2);
  std::string html = make_report({evaluate_made(made_two()), evaluate_explained(made)});
  html.replace(html.rfind("</body>"), 0, R"(<script>document.body.dataset.loaded=
      [...document.images].filter(i => i.complete && i.naturalWidth > 0).length + "/" +
      document.images.length</script>)");
  const TemporaryFolder folder;
  const std::string page =
      open_in_browser(write_report(html, folder.path() / "report"), folder.path());
  EXPECT_THAT(page, HasSubstr("data-loaded=\"6/6\""));
}

}  // namespace
}  // namespace posevote
