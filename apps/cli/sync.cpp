// posevote sync: a robot's own database and the shared one become the same again.
#include <iostream>

#include "command.hpp"
#include "commands.hpp"
#include "database.hpp"
#include "sync_text.hpp"

namespace posevote::cli {
namespace {

void print(const SyncReport& report, const ObjectStore& there) {
  print_views("sent", report.sent);
  print_views("received", report.received);
  print_views("removed here", report.removed_here);
  print_views("removed there", report.removed_there);
  print_views("not sent", report.not_sent);
  print_views("not removed there", report.not_removed_there);
  print_conflicts(report.conflicts);
  std::cout << report.in_both << " views were the same, " << report.sent.size() << " sent, "
            << report.received.size() << " received, "
            << report.removed_here.size() + report.removed_there.size() << " removed, "
            << report.conflicts.size() << " conflicts with " << there.location() << '\n';
}

Json to_json(const SyncReport& report, const ObjectStore& there) {
  return {{"database", there.location()},
          {"in_both", report.in_both},
          {"sent", views_json(report.sent)},
          {"received", views_json(report.received)},
          {"removed_here", views_json(report.removed_here)},
          {"removed_there", views_json(report.removed_there)},
          {"not_sent", views_json(report.not_sent)},
          {"not_removed_there", views_json(report.not_removed_there)},
          {"conflicts", conflicts_json(report.conflicts)}};
}

}  // namespace

void add_sync(CLI::App& app, CommandContext& context) {
  struct Arguments {
    std::string database, remote;
    bool json = false, keep = false;
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = add_command(
      app, "sync", "Make two databases the same, each of which was changed without the other",
      "  posevote sync postgresql://robot@server/objects    with the own database\n"
      "  posevote sync postgresql://robot@server/objects --db robot.db --keep\n"
      "      may be stopped at any moment and run again: nothing is lost, nothing is there twice");
  command->add_option("OTHER", arguments->remote, "The shared database, or any other")->required();
  command->add_flag("--keep", arguments->keep,
                    "Only add views; else what was removed on one side is removed on the other");
  command->add_flag("--json", arguments->json, "One line of JSON");
  add_database(*command, arguments->database);
  command->callback([arguments, &context] {
    const auto there = open_database(arguments->remote, Access::existing);
    const auto here = open_database(arguments->database, Access::create);
    SyncOptions options;
    options.removals = !arguments->keep;
    const SyncReport report = sync_objects(*here, *there, options);
    if (arguments->json)
      std::cout << to_line(to_json(report, *there)) << '\n';
    else
      print(report, *there);
    if (report.not_sent.empty() && report.not_removed_there.empty()) return;
    print_error(
        "database '" + there->location() +
        "' gives this user no right to some of the changes; they are tried again next time");
    context.exit_status = 1;
  });
}

}  // namespace posevote::cli
