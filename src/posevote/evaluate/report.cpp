#include "posevote/evaluate/report.hpp"

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "posevote/core/error.hpp"
#include "posevote/evaluate/cases.hpp"
#include "posevote/evaluate/results.hpp"
#include "posevote/evaluate/summary.hpp"
#include "posevote/verify/verifier.hpp"

namespace posevote {
namespace {

const char* const page_style = R"(:root{color-scheme:light dark;--paper:#fcfcfa;--card:#fff;
--ink:#1c1f23;--soft:#667080;--line:#dfe2e6;--good:#11875d;--bad:#c8323c;
--c0:#2763c4;--c1:#d4691e;--c2:#1d8a63;--c3:#9a44b8;--c4:#b3364f;--c5:#5c6b2f}
@media (prefers-color-scheme:dark){:root{--paper:#15181c;--card:#1d2126;--ink:#e6e8eb;
--soft:#98a2b0;--line:#343a42;--good:#4cc795;--bad:#ff7b81;
--c0:#7aa7f5;--c1:#f0a064;--c2:#5fcfa3;--c3:#c98be0;--c4:#f08aa0;--c5:#b4c67a}}
*{box-sizing:border-box}
body{margin:0 auto;max-width:72rem;padding:1.5rem;background:var(--paper);color:var(--ink);
font:15px/1.5 system-ui,sans-serif}
h1{font-size:1.7rem;margin:.2rem 0}h2{font-size:1.35rem;margin:2.5rem 0 .5rem;
border-bottom:1px solid var(--line);padding-bottom:.3rem}h3{font-size:1.05rem;margin:1.5rem 0 .4rem}
a{color:var(--c0)}.soft,.note{color:var(--soft)}.note{font-size:.88rem;margin:.3rem 0}
nav a{margin-right:1rem}
.cards{display:grid;grid-template-columns:repeat(auto-fit,minmax(8.5rem,1fr));gap:.8rem;margin:1rem 0}
.cards div{background:var(--card);border:1px solid var(--line);border-radius:.6rem;padding:.7rem .9rem}
.cards b{display:block;font-size:1.5rem;line-height:1.2}.cards span{color:var(--soft);font-size:.85rem}
.table{overflow-x:auto}table{border-collapse:collapse;font-variant-numeric:tabular-nums;
font-size:.9rem}th,td{padding:.28rem .5rem;text-align:right;border-bottom:1px solid var(--line);
white-space:nowrap}th{color:var(--soft);font-weight:600}th:first-child,td:first-child{text-align:left;
padding-left:0}tbody tr:last-child td{font-weight:600}.plain tbody tr:last-child td{font-weight:400}
.charts{display:grid;grid-template-columns:repeat(auto-fit,minmax(24rem,1fr));gap:1rem}
.cases{display:grid;grid-template-columns:repeat(auto-fill,minmax(19rem,1fr));gap:1rem}
figure{margin:0;background:var(--card);border:1px solid var(--line);border-radius:.6rem;
overflow:hidden}figcaption{padding:.6rem .8rem;font-size:.85rem;overflow-wrap:anywhere}
.picture{position:relative}.picture img{display:block;width:100%;height:auto}
.picture svg{position:absolute;inset:0;width:100%;height:100%}
.picture polygon,.picture rect{fill:none;stroke-width:2.5px;vector-effect:non-scaling-stroke}
.picture .claim{stroke:#ff3b47}.picture .truth{stroke:#35d08a;stroke-dasharray:7 4}
.picture .pose{stroke:#ffb02e}.match{fill:none;stroke:#3ddcff;stroke-width:1.5px;
vector-effect:non-scaling-stroke}.vote{fill:#e45cff;fill-opacity:.6}.agree{fill:#ffb02e}
.evidence{display:none}figure:has(details[open]) .evidence{display:inline}
figure:has(details[open]) img{filter:grayscale(1) brightness(.65)}
details{margin-top:.4rem}summary{cursor:pointer;color:var(--c0)}
details table{font-size:.8rem;margin:.3rem 0}details td{padding:.1rem .6rem;white-space:normal}
details p{margin:.2rem 0}
@media print{:root{--paper:#fff;--card:#fff;--ink:#000;--soft:#555;--line:#ccc;--good:#11875d;
--bad:#c8323c;--c0:#2763c4;--c1:#d4691e;--c2:#1d8a63;--c3:#9a44b8;--c4:#b3364f;--c5:#5c6b2f}
figure,.chart,tr,.cards{break-inside:avoid}h2,h3{break-after:avoid}nav{display:none}
body{max-width:none;padding:0}.table{overflow:visible}table{font-size:.7rem}.charts{grid-template-columns:1fr 1fr}th,td{padding:.1rem .25rem}}
)";

std::string wrap(const std::string& tag, const std::string& css, const std::string& content) {
  return "<" + tag + " class=\"" + css + "\">" + content + "</" + tag + ">\n";
}

std::string card(const std::string& value, const std::string& meaning) {
  return "<div><b>" + escape_html(value) + "</b><span>" + escape_html(meaning) + "</span></div>";
}

std::string cards(const Evaluation& evaluation) {
  const Summary s = summarize("all", evaluation.dataset, evaluation.outcomes);
  const Summary negative = summarize("", evaluation.negatives, evaluation.negative_outcomes);
  const Interval interval = s.recall_interval();
  std::string html =
      card(std::to_string(s.right) + " / " + std::to_string(s.asked), "right / asked") +
      card(percent(s.recall()), "recall, 95 % within " + fixed(100 * interval.low, 0) + " to " +
                                    fixed(100 * interval.high, 0) + " %") +
      card(std::to_string(s.false_positives),
           "false positives on " + std::to_string(s.images) + " pictures");
  if (negative.images > 0)
    html += card(std::to_string(negative.false_positives),
                 "on " + std::to_string(negative.images) + " pictures without any object");
  if (s.twins > 0) html += card(std::to_string(s.twins), "named as the twin");
  return wrap("div", "cards",
              html + card(fixed(s.total.median_ms, 0) + " ms",
                          "median time, 95th percentile " + fixed(s.total.p95_ms, 0) + " ms"));
}

std::string recall_plot(const Evaluation& evaluation) {
  std::vector<IntervalRow> rows;
  for (const Summary& s : summarize_groups(evaluation.dataset, evaluation.outcomes)) {
    if (s.asked == 0) continue;
    const Interval interval = s.recall_interval();
    rows.push_back(
        {s.name.empty() ? "(no group)" : s.name, s.recall(), interval.low, interval.high});
  }
  return rows.empty() ? "" : interval_svg("Recall by group, with 95 % interval", rows);
}

std::string titled(Table table, const std::string& title) {
  table.title = title;
  return table.to_html();
}

std::string gallery(const Evaluation& evaluation, const CaseList& list,
                    const ReportOptions& options) {
  const std::size_t shown = std::min(list.cases.size(), options.max_cases);
  std::string figures;
  for (std::size_t i = 0; i < shown; ++i) {
    const auto why = evaluation.explanations.find(question_of(list.cases[i]));
    figures +=
        case_figure(list.cases[i], why == evaluation.explanations.end() ? nullptr : &why->second,
                    options.picture);
  }
  std::string heading = list.title + " (" + std::to_string(list.cases.size());
  if (shown < list.cases.size()) heading += ", the first " + std::to_string(shown) + " shown";
  return "<h3>" + escape_html(heading + ")") + "</h3>\n" + wrap("div", "cases", figures);
}

std::string silhouettes(const Evaluation& evaluation, const ReportOptions& options) {
  if (evaluation.silhouettes.empty()) return "";
  std::string figures;
  for (const SilhouetteCase& item :
       worst_silhouettes(evaluation.silhouettes, options.max_silhouettes))
    figures += silhouette_figure(evaluation.dataset, item, options.picture);
  return wrap("div", "plain",
              titled(silhouette_table(evaluation.dataset.name, evaluation.silhouettes),
                     "Taught silhouettes")) +
         "<p class=\"note\">The views that fit worst: red is what was taught, dashed green the "
         "true silhouette.</p>\n" +
         wrap("div", "cases", figures);
}

std::string evaluation_html(const Evaluation& evaluation, std::size_t number,
                            const ReportOptions& options) {
  std::string html =
      "<h2 id=\"set" + std::to_string(number) + "\">" + escape_html(evaluation.dataset.name) +
      "</h2>\n<p>" + escape_html(evaluation.dataset.description) + "</p>\n<p class=\"soft\">" +
      std::to_string(evaluation.objects) + " objects taught from " +
      std::to_string(evaluation.views) + " views with " + std::to_string(evaluation.features) +
      " features</p>\n" + cards(evaluation) + titled(group_table(evaluation), "By group");
  html += wrap("div", "charts",
               recall_plot(evaluation) + precision_recall_chart(evaluation).to_svg() +
                   false_alarm_chart(evaluation).to_svg());
  html += titled(time_table(evaluation), "Time") +
          wrap("div", "plain", titled(ranking_table(evaluation), "Best threshold afterwards"));
  const Table confusion = confusion_table(evaluation);
  if (!confusion.rows.empty()) html += wrap("div", "plain", titled(confusion, "Confusions"));
  if (!evaluation.refused.empty())
    html += wrap("div", "plain", titled(refused_table(evaluation), "Views that were refused"));
  html += silhouettes(evaluation, options);
  for (const CaseList& list : worst_cases(evaluation)) html += gallery(evaluation, list, options);
  return html;
}

std::string section_html(const ReportSection& section) {
  std::string html = "<h2>" + escape_html(section.title) + "</h2>\n";
  if (!section.text.empty()) html += "<p>" + escape_html(section.text) + "</p>\n";
  for (const Table& table : section.tables) html += wrap("div", "plain", table.to_html());
  std::string charts;
  for (const Chart& chart : section.charts) charts += chart.to_svg();
  return charts.empty() ? html : html + wrap("div", "charts", charts);
}

// The whole in one paragraph.
std::string in_short(const std::vector<Evaluation>& evaluations) {
  Summary all, negatives;
  for (const Evaluation& evaluation : evaluations) {
    const Summary s = summarize("", evaluation.dataset, evaluation.outcomes);
    all.images += s.images;
    all.asked += s.asked;
    all.right += s.right;
    all.false_positives += s.false_positives;
    const Summary n = summarize("", evaluation.negatives, evaluation.negative_outcomes);
    negatives.images += n.images;
    negatives.false_positives += n.false_positives;
  }
  const auto number = [](int count) { return std::to_string(count); };
  std::string text = "**In short:** of " + number(all.asked) + " objects in " + number(all.images) +
                     " pictures of " + number(static_cast<int>(evaluations.size())) +
                     (evaluations.size() == 1 ? " data set " : " data sets ") + number(all.right) +
                     " are found (" + percent(all.recall()) + "); " + number(all.false_positives) +
                     " answers are false";
  if (negatives.images > 0)
    text += ", and " + number(negatives.false_positives) + " on " + number(negatives.images) +
            " pictures that show none of the objects";
  return text + ".";
}

void append_rows(Table& table, const Table& more) {
  if (table.rows.empty())
    table = more;
  else
    table.rows.insert(table.rows.end(), more.rows.begin(), more.rows.end());
}

ChartSeries alarms_over_dial(const std::string& name, const std::vector<TestOutcome>& outcomes,
                             double largest) {
  constexpr int kPoints = 30;
  const auto claims = rank_detections(outcomes, ranking("probability"));
  ChartSeries series{name, {}};
  for (int i = 1; i <= kPoints; ++i) {
    const double dial = largest * i / kPoints, least = least_probability(dial);
    const auto alarms = std::ranges::count_if(
        claims, [&](const RankedDetection& claim) { return !claim.right && claim.value >= least; });
    series.points.push_back(
        {dial, 1000 * static_cast<double>(alarms) / static_cast<double>(outcomes.size())});
  }
  return series;
}

}  // namespace

std::string to_text(const ReportSection& section) {
  std::string text = section.title + "\n\n";
  if (!section.text.empty()) text += section.text + "\n\n";
  for (const Table& table : section.tables) text += table.to_text() + "\n";
  return text;
}

std::string to_json(const ReportSection& section) {
  nlohmann::ordered_json tables = nlohmann::ordered_json::array();
  for (const Table& table : section.tables)
    tables.push_back({{"title", table.title},
                      {"header", table.header},
                      {"rows", table.rows},
                      {"note", table.note}});
  return nlohmann::ordered_json{{"title", section.title}, {"tables", tables}}.dump();
}

Chart precision_recall_chart(const Evaluation& evaluation) {
  Chart chart{"Precision over recall", {"recall", 0, 1}, {"precision", 0, 1}, {}};
  const int asked = summarize("", evaluation.dataset, evaluation.outcomes).asked;
  for (const Ranking& ranking : rankings()) {
    ChartSeries series{ranking.name, {}};
    for (const CurvePoint& point : make_curve(rank_with_negatives(evaluation, ranking)))
      if (asked > 0)
        series.points.push_back(
            {static_cast<double>(point.right) / asked,
             static_cast<double>(point.right) / (point.right + point.false_positives)});
    chart.series.push_back(std::move(series));
  }
  return chart;
}

Chart false_alarm_chart(const Evaluation& evaluation) {
  const double largest = VerifyOptions().false_alarms_per_1000_images;
  Chart chart{"False positives over the dial",
              {"dial: false positives accepted per 1000 pictures", 0, largest},
              {"found per 1000 pictures", 0, 0},
              {{"as accepted", {{0, 0}, {largest, largest}}}}};
  const auto add = [&](const Dataset& dataset, const std::vector<TestOutcome>& outcomes) {
    if (!outcomes.empty())
      chart.series.push_back(alarms_over_dial(dataset.name, outcomes, largest));
  };
  add(evaluation.dataset, evaluation.outcomes);
  add(evaluation.negatives, evaluation.negative_outcomes);
  return chart;
}

std::string make_report(const std::vector<Evaluation>& evaluations,
                        const std::vector<ReportSection>& sections, const ReportOptions& options) {
  std::string names, links, body;
  for (std::size_t i = 0; i < evaluations.size(); ++i) {
    const std::string name = escape_html(evaluations[i].dataset.name);
    names += (names.empty() ? "" : ", ") + name;
    links += "<a href=\"#set" + std::to_string(i) + "\">" + name + "</a>\n";
    body += evaluation_html(evaluations[i], i, options);
  }
  if (evaluations.size() > 1)
    body = "<nav>" + links + "</nav>\n" + wrap("div", "plain", set_table(evaluations).to_html()) +
           body;
  for (const ReportSection& section : sections) body += section_html(section);
  return "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">\n<title>" +
         names + " – posevote evaluation</title>\n<style>\n" + page_style + chart_style() +
         "</style></head>\n<body>\n<h1>How good is it?</h1>\n<p class=\"soft\">Right: the name of "
         "a "
         "listed object that was not found before, and a box that overlaps its box by at least one "
         "half (intersection over union, inside the picture). Anything else is a false positive; "
         "objects that are optional or hidden to more than 85 % are neither asked for nor wrong. "
         "In "
         "pictures: red is what was claimed, dashed green is where the listed object is.</p>\n" +
         body + "</body></html>\n";
}

std::filesystem::path write_report(const std::string& html, const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  auto file = folder / "index.html";
  std::ofstream stream(file, std::ios::binary);
  stream << html;
  stream.close();
  if (!stream) throw Error(ErrorCode::io, "cannot write " + file.string());
  return file;
}

std::string make_markdown(const std::vector<Evaluation>& evaluations,
                          const std::vector<ReportSection>& sections) {
  std::string text =
      "# Accuracy\n\nWritten by `posevote evaluate DATASET... --markdown FILE`.\n\n" +
      in_short(evaluations) + "\n\n" + set_table(evaluations).to_markdown();
  text +=
      "\n**Right** is the name of a listed object that was not found before, with a box that "
      "overlaps its box by at least one half (intersection over union, inside the picture). "
      "Any other answer is **false**, except on objects that are optional or hidden to more "
      "than 85 %.\n";
  Table silhouettes;
  for (const Evaluation& evaluation : evaluations)
    append_rows(silhouettes, silhouette_table(evaluation.dataset.name, evaluation.silhouettes));
  if (!silhouettes.rows.empty()) text += "\n## Taught silhouettes\n\n" + silhouettes.to_markdown();
  text += "\n## Time\n\n" + set_time_table(evaluations).to_markdown();
  for (const Evaluation& evaluation : evaluations) {
    text += "\n## " + evaluation.dataset.name + "\n\n" + evaluation.dataset.description + "\n\n" +
            group_table(evaluation).to_markdown();
    for (const std::string& mistake : mistakes_of(evaluation)) text += "\n- " + mistake;
    text += "\n";
  }
  for (const ReportSection& section : sections) {
    text += "\n## " + section.title + "\n\n" + (section.text.empty() ? "" : section.text + "\n\n");
    for (const Table& table : section.tables) text += table.to_markdown() + "\n";
  }
  return text;
}

}  // namespace posevote
