// posevote objects diff, merge: what two databases know of each other's objects.
#include <iostream>

#include "command.hpp"
#include "database.hpp"
#include "objects.hpp"
#include "sync_text.hpp"

namespace posevote::cli {
namespace {

void diff(const ObjectStore& a, const ObjectStore& b, bool json) {
  const Difference difference = compare_views(list_views(a), list_views(b));
  if (json) {
    std::cout << to_line({{"only_a", views_json(difference.only_a)},
                          {"only_b", views_json(difference.only_b)},
                          {"in_both", difference.in_both},
                          {"conflicts", conflicts_json(difference.conflicts)}})
              << '\n';
    return;
  }
  print_views("only A", difference.only_a);
  print_views("only B", difference.only_b);
  print_conflicts(difference.conflicts);
  std::cout << difference.only_a.size() << " views only in A, " << difference.only_b.size()
            << " only in B, " << difference.in_both << " in both, " << difference.conflicts.size()
            << " conflicts\n";
}

void merge(const ObjectStore& from, ObjectStore& to, bool json) {
  const MergeReport report = merge_objects(from, to);
  if (json) {
    std::cout << to_line({{"from", from.location()},
                          {"added", views_json(report.added)},
                          {"known", report.known},
                          {"conflicts", conflicts_json(report.conflicts)}})
              << '\n';
    return;
  }
  print_views("added", report.added);
  print_conflicts(report.conflicts);
  std::cout << report.added.size() << " views added from " << from.location() << ", "
            << report.known << " were there already, " << report.conflicts.size() << " conflicts\n";
}

}  // namespace

void add_diff(CLI::App& objects) {
  struct Arguments {
    std::string a, b;
    bool json = false;
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command =
      add_command(objects, "diff", "Say which views two databases do not have in common",
                  "  posevote objects diff robot.db laboratory.db\n"
                  "  posevote objects diff robot.db postgresql://robot@server/objects");
  command->add_option("A", arguments->a, "A database")->required();
  command->add_option("B", arguments->b, "Another one")->required();
  command->add_flag("--json", arguments->json, "One line of JSON");
  command->callback([arguments] {
    diff(*open_database(arguments->a, Access::read_only),
         *open_database(arguments->b, Access::read_only), arguments->json);
  });
}

void add_merge(CLI::App& objects) {
  struct Arguments {
    std::string database;
    std::vector<std::string> from;
    bool json = false;
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = add_command(
      objects, "merge", "Add all views of other databases that are not there yet; remove nothing",
      "  posevote objects merge robot-1.db robot-2.db --db laboratory.db\n"
      "      may be stopped at any moment and run again");
  command->add_option("FROM", arguments->from, "The databases to take views from")->required();
  command->add_flag("--json", arguments->json, "One line of JSON for each database");
  add_database(*command, arguments->database);
  command->callback([arguments] {
    std::vector<std::unique_ptr<ObjectStore>> sources;
    for (const std::string& from : arguments->from)
      sources.push_back(open_database(from, Access::read_only));
    const auto to = open_database(arguments->database, Access::create);
    for (const auto& from : sources) merge(*from, *to, arguments->json);
  });
}

}  // namespace posevote::cli
