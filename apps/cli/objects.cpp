// posevote objects: look at, change, move what was taught.
#include <cmath>
#include <iostream>

#include "command.hpp"
#include "database.hpp"
#include "objects.hpp"
#include "pictures.hpp"
#include "posevote/core/error.hpp"
#include "posevote/evaluate/table.hpp"
#include "posevote/image/image_header.hpp"
#include "posevote/json/recognition_json.hpp"
#include "posevote/store/transfer.hpp"
#include "store_json.hpp"

namespace posevote::cli {
namespace {

std::string yaw_text(double yaw_deg) {
  return std::isnan(yaw_deg) ? "" : fixed(yaw_deg, 0);
}

Json view_line(const std::string& object, const ViewSummary& view) {
  Json json{{"object", object}};
  json.update(view_json(view));
  return json;
}

void list(const ObjectStore& store, bool json, bool names) {
  const auto objects = store.list();
  if (json || names) {
    for (const ObjectSummary& object : objects)
      std::cout << (json ? to_line(object_json(object)) : object.name) << '\n';
    return;
  }
  if (objects.empty()) {
    std::cout << "no objects in " << store.location() << '\n';
    return;
  }
  Table table;
  table.header = {"object", "views", "features", "last taught"};
  for (const ObjectSummary& object : objects)
    table.rows.push_back({object.name, std::to_string(object.views),
                          std::to_string(object.features), object.last_taught_at});
  std::cout << table.to_text() << objects.size() << " objects in " << store.location()
            << ", features " << store.features()->signature << '\n';
}

void show(const ObjectStore& store, const std::string& name, bool json) {
  const auto views = store.views(name);
  Table table;
  table.header = {"view", "yaw",    "picture", "features", "covers",
                  "by",   "taught", "from",    "version"};
  for (const ViewSummary& view : views) {
    if (json) std::cout << to_line(view_line(name, view)) << '\n';
    table.rows.push_back(
        {view.id, yaw_text(view.yaw_deg),
         std::to_string(view.image_size.width) + " x " + std::to_string(view.image_size.height),
         std::to_string(view.features), percent(view.coverage, 0), view.method,
         view.provenance.taught_at, view.provenance.source, view.provenance.version});
  }
  if (!json) std::cout << name << "\n" << table.to_text();
}

/// The kept pictures and masks, as FOLDER/view-ID.jpg (or .png, ...) and FOLDER/view-ID-mask.png.
void save_pictures(const ObjectStore& store, const std::string& name, const std::string& folder) {
  make_folder(folder);
  for (const ViewSummary& summary : store.views(name)) {
    const TaughtView view = store.view(name, summary.id);
    const auto header = parse_image_header(view.picture.data(), view.picture.size());
    const std::string stem = folder + "/view-" + summary.id;
    save_bytes(stem + "." + (header ? header->format : "picture"), view.picture);
    if (!view.mask.empty()) save_bytes(stem + "-mask.png", view.mask);
  }
  std::cerr << "pictures and masks are in " << folder << '\n';
}

void add_list(CLI::App& objects) {
  struct Arguments {
    std::string database;
    bool json = false, names = false;
  };
  auto a = std::make_shared<Arguments>();
  CLI::App* command = add_command(objects, "list", "List all objects", "  posevote objects list");
  command->add_flag("--json", a->json, "One line of JSON for each object");
  command->add_flag("--names", a->names, "Names only, one a line")->excludes("--json");
  add_database(*command, a->database);
  command->callback(
      [a] { list(*open_database(a->database, Access::existing), a->json, a->names); });
}

void add_show(CLI::App& objects) {
  struct Arguments {
    std::string database, name, pictures;
    bool json = false;
  };
  auto a = std::make_shared<Arguments>();
  CLI::App* command =
      add_command(objects, "show", "Show an object's views and where they come from",
                  "  posevote objects show mug\n"
                  "  posevote objects show mug --pictures mug-views/");
  command->add_option("NAME", a->name, "Name of the object")->required();
  command
      ->add_option("--pictures", a->pictures, "Also write the kept pictures and masks into FOLDER")
      ->type_name("FOLDER");
  command->add_flag("--json", a->json, "One line of JSON for each view");
  add_database(*command, a->database);
  command->callback([a] {
    const auto store = open_database(a->database, Access::existing);
    show(*store, a->name, a->json);
    if (!a->pictures.empty()) save_pictures(*store, a->name, a->pictures);
  });
}

void add_remove(CLI::App& objects) {
  struct Arguments {
    std::string database;
    std::vector<std::string> names, views;
  };
  auto a = std::make_shared<Arguments>();
  CLI::App* command = add_command(objects, "remove", "Remove objects, or single views of one",
                                  "  posevote objects remove mug cup\n"
                                  "  posevote objects remove mug --view 3 --view 4");
  command->add_option("NAME", a->names, "Names of the objects")->required();
  command->add_option("--view", a->views, "Only these views of the one object named")
      ->type_name("ID")
      ->allow_extra_args(false);
  add_database(*command, a->database);
  command->callback([a] {
    if (!a->views.empty() && a->names.size() != 1) wrong_usage("--view goes with one object only");
    const auto store = open_database(a->database, Access::existing);
    store->transact([&] {
      if (a->views.empty())
        for (const std::string& name : a->names) store->remove_object(name);
      for (const std::string& view : a->views) store->remove_view(a->names.front(), view);
    });
  });
}

void add_rename(CLI::App& objects) {
  struct Arguments {
    std::string database, from, to;
  };
  auto a = std::make_shared<Arguments>();
  CLI::App* command = add_command(objects, "rename", "Rename an object",
                                  "  posevote objects rename mug 'blue mug'");
  command->add_option("NAME", a->from, "Its present name")->required();
  command->add_option("NEW", a->to, "Its new name, which must be free")->required();
  add_database(*command, a->database);
  command->callback(
      [a] { open_database(a->database, Access::existing)->rename_object(a->from, a->to); });
}

void add_export(CLI::App& objects) {
  struct Arguments {
    std::string database, file;
    std::vector<std::string> names;
    bool force = false;
  };
  auto a = std::make_shared<Arguments>();
  CLI::App* command = add_command(objects, "export", "Write objects into one portable file",
                                  "  posevote objects export kitchen.posevote\n"
                                  "  posevote objects export mugs.posevote mug 'blue mug'");
  command->add_option("FILE", a->file, "The file to make")->required();
  command->add_option("NAME", a->names, "Names of the objects; none: all");
  command->add_flag("--force", a->force, "Replace FILE if it exists");
  add_database(*command, a->database);
  command->callback([a] {
    const auto store = open_database(a->database, Access::existing);
    const auto result = export_objects(*store, a->file, a->names, a->force);
    std::cout << result.objects << " objects, " << result.views_added << " views written to "
              << a->file << '\n';
  });
}

void add_import(CLI::App& objects) {
  struct Arguments {
    std::string database, file;
    std::vector<std::string> names;
    bool merge = false, replace = false;
  };
  auto a = std::make_shared<Arguments>();
  CLI::App* command =
      add_command(objects, "import", "Take objects over from an exported file or another database",
                  "  posevote objects import kitchen.posevote\n"
                  "  posevote objects import kitchen.posevote mug --merge");
  command->add_option("FILE", a->file, "The file to read")->required();
  command->add_option("NAME", a->names, "Names of the objects; none: all");
  auto* merge =
      command->add_flag("--merge", a->merge, "Add views to objects that are there already");
  command->add_flag("--replace", a->replace, "Replace objects that are there already")
      ->excludes(merge);
  add_database(*command, a->database);
  command->callback([a] {
    const auto from =
        open_store(a->file, Access::read_only);  // before a database is made for nothing
    const auto to = open_database(a->database, Access::create);
    const auto result = copy_objects(*from, *to, a->names,
                                     a->merge     ? OnConflict::merge
                                     : a->replace ? OnConflict::replace
                                                  : OnConflict::refuse);
    std::cout << result.objects << " objects, " << result.views_added << " views added";
    if (result.views_known > 0) std::cout << ", " << result.views_known << " were there already";
    std::cout << '\n';
  });
}

}  // namespace

void add_objects(CLI::App& app, CommandContext& context) {
  CLI::App* objects = add_command(app, "objects", "Look at, change and move what was taught", "");
  objects->require_subcommand(1);
  add_list(*objects);
  add_show(*objects);
  add_remove(*objects);
  add_rename(*objects);
  add_export(*objects);
  add_import(*objects);
  add_diff(*objects);
  add_merge(*objects);
  add_rebuild(*objects, context);
  add_impostors(*objects, context);
}

}  // namespace posevote::cli
