#include "studio/trash.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>

#include "http/access.hpp"
#include "http/problem.hpp"
#include "posevote/json/recognition_json.hpp"
#include "posevote/store/sqlite/sqlite_store.hpp"
#include "studio/catalogue.hpp"
#include "studio/files.hpp"

namespace posevote::server {
namespace {

namespace fs = std::filesystem;

std::unique_ptr<ObjectStore> open_small(const std::string& path, Access access) {
  SqliteOptions options;
  options.access = access;
  options.write_ahead = false;
  return open_sqlite_store(path, options);
}

bool is_id(const std::string& text) {
  return text.size() == 32 && text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

double age_s(const fs::directory_entry& file) {
  std::error_code gone;
  const auto age = fs::file_time_type::clock::now() - file.last_write_time(gone);
  return std::chrono::duration<double>(age).count();
}

void require_object(const ObjectStore& store, const std::string& name) {
  if (!has_object(store, name)) throw not_found("there is no object '" + name + "'");
}

}  // namespace

Trash::Trash(std::string folder, double keep_s) : folder_(std::move(folder)), keep_s_(keep_s) {
  expire();
}

std::string Trash::keep(const ObjectStore& store, const std::string& object,
                        const std::string& view, const std::string& into) const {
  std::string id = random_hex(16);
  const auto to = open_small(path(id) + ".posevote", Access::create);
  to->transact([&] {
    for (const ViewSummary& summary : store.views(object))
      if (view.empty() || summary.id == view)
        to->add_view(object, store.view(object, summary.id), store.features().value());
  });
  write_file(path(id) + ".json", to_line(Json{{"object", object}, {"view", view}, {"into", into}}));
  return id;
}

std::string Trash::delete_object(ObjectStore& store, const std::string& object) {
  const std::lock_guard lock(mutex_);
  std::string id;
  store.transact([&] {
    require_object(store, object);
    id = keep(store, object, "", "");
    store.remove_object(object);
  });
  return id;
}

std::string Trash::delete_view(ObjectStore& store, const std::string& object,
                               const std::string& view) {
  const std::lock_guard lock(mutex_);
  std::string id;
  store.transact([&] {
    require_object(store, object);
    static_cast<void>(store.view(object, view));
    id = keep(store, object, view, "");
    store.remove_view(object, view);
  });
  return id;
}

std::string Trash::merge(ObjectStore& store, const std::string& object, const std::string& into) {
  if (object == into) throw invalid("an object cannot be merged into itself");
  const std::lock_guard lock(mutex_);
  std::string id;
  store.transact([&] {
    require_object(store, object);
    require_object(store, into);
    id = keep(store, object, "", into);
    Json added = Json::array();
    for (const AddResult& result : copy_views(store, object, store, into))
      if (result.added) added.push_back(result.id);
    write_file(path(id) + ".added", added.dump());
    store.remove_object(object);
  });
  return id;
}

std::string Trash::undo(ObjectStore& store, const std::string& id) {
  if (!is_id(id)) throw not_found("this cannot be undone any more");
  const std::lock_guard lock(mutex_);
  const Deletion note = this->note(id);
  const auto from = open_small(path(id) + ".posevote", Access::read_only);
  store.transact([&] {
    if (note.view.empty() && has_object(store, note.object))
      throw Error(ErrorCode::already_exists,
                  "there is another object '" + note.object + "' now; rename it first");
    if (!note.into.empty() && has_object(store, note.into)) {
      std::ifstream file(path(id) + ".added");
      const auto present = store.views(note.into);
      for (const auto& view : Json::parse(file, nullptr, false))
        if (std::ranges::find(present, view.get<std::string>(), &ViewSummary::id) != present.end())
          store.remove_view(note.into, view.get<std::string>());
    }
    copy_views(*from, note.object, store, note.object);
  });
  forget(id);
  return note.object;
}

Deletion Trash::note(const std::string& id) const {
  const std::string file = path(id) + ".json";
  std::ifstream stream(file);
  const Json json = Json::parse(stream, nullptr, false);
  if (!json.is_object()) throw not_found("this cannot be undone any more");
  return {id, json.value("object", ""), json.value("view", ""), json.value("into", ""),
          age_s(fs::directory_entry(file))};
}

std::vector<Deletion> Trash::list() const {
  const std::lock_guard lock(mutex_);
  std::vector<Deletion> all;
  for (const auto& entry : fs::directory_iterator(folder_)) {
    const std::string id = entry.path().stem().string();
    if (is_id(id) && entry.path().extension() == ".json") all.push_back(note(id));
  }
  std::ranges::sort(all, {}, &Deletion::age_s);
  return all;
}

void Trash::forget(const std::string& id) const {
  std::error_code ignored;
  remove_database_file(path(id) + ".posevote");
  for (const char* suffix : {".json", ".added"}) fs::remove(path(id) + suffix, ignored);
}

void Trash::expire() {
  const std::lock_guard lock(mutex_);
  std::vector<std::string> old;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder_, error)) {
    const std::string id = entry.path().stem().string();
    if (is_id(id) && age_s(entry) > keep_s_) old.push_back(id);
  }
  for (const std::string& id : old) forget(id);
}

}  // namespace posevote::server
