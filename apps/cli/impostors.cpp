// posevote objects impostors: pictures of what must not be taken for an object.
#include <iostream>

#include "database.hpp"
#include "objects.hpp"
#include "pictures.hpp"
#include "posevote/core/error.hpp"
#include "posevote/evaluate/table.hpp"
#include "posevote/image/inputs.hpp"

namespace posevote::cli {
namespace {

struct ImpostorArguments {
  std::string database;
  std::vector<std::string> inputs, ids;
};

void list(const ObjectStore& store) {
  Table table;
  table.header = {"impostor", "features", "taught", "from"};
  for (const ImpostorSummary& impostor : store.impostors())
    table.rows.push_back({impostor.id, std::to_string(impostor.features),
                          impostor.provenance.taught_at, impostor.provenance.source});
  if (table.rows.empty())
    std::cout << "no impostors in " << store.location() << '\n';
  else
    std::cout << table.to_text();
}

void add(const ImpostorArguments& arguments) {
  const auto store = open_database(arguments.database, Access::create);
  FeatureOptions options;
  choose_features(options, store.get(), "");
  const auto extractor = make_extractor(options);
  for (const std::string& argument : arguments.inputs)
    for (const Input& input : expand_input(argument)) {
      LoadedPicture picture = load_picture(input.path);
      Impostor impostor;
      impostor.features = extractor->extract(picture.image);
      impostor.picture = std::move(picture.encoded);
      impostor.provenance = {input.path, "", POSEVOTE_VERSION};
      const AddResult result = store->add_impostor(impostor, record_features(options));
      std::cout << "impostor " << result.id << (result.added ? " from " : " was already ")
                << input.path << ", " << impostor.features.size() << " features\n";
    }
}

}  // namespace

void add_impostors(CLI::App& objects, CommandContext&) {
  auto a = std::make_shared<ImpostorArguments>();
  CLI::App* impostors = add_command(objects, "impostors",
                                    "Pictures that show no object: surroundings, false detections",
                                    "  posevote objects impostors add empty-room.jpg\n"
                                    "  posevote objects impostors list");
  impostors->require_subcommand(1);
  CLI::App* list_command = add_command(*impostors, "list", "List them", "");
  add_database(*list_command, a->database);
  list_command->callback([a] { list(*open_database(a->database, Access::existing)); });
  CLI::App* add_one = add_command(*impostors, "add", "Add pictures without any taught object", "");
  add_one->add_option("IMAGE", a->inputs, "Pictures or folders of pictures")->required();
  add_database(*add_one, a->database);
  add_one->callback([a] { add(*a); });
  CLI::App* remove = add_command(*impostors, "remove", "Remove some", "");
  remove->add_option("ID", a->ids, "As shown by list")->required();
  add_database(*remove, a->database);
  remove->callback([a] {
    const auto store = open_database(a->database, Access::existing);
    store->transact([&] {
      for (const std::string& id : a->ids) store->remove_impostor(id);
    });
  });
}

}  // namespace posevote::cli
