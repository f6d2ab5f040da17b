#include <pybind11/functional.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>

#include "posevote/store/address.hpp"
#include "posevote/store/open_store.hpp"
#include "posevote/store/transfer.hpp"
#include "views.hpp"

namespace posevote::python {
namespace {

template <class Value>
Value choose(const std::string& word, const std::vector<std::pair<std::string, Value>>& known,
             const char* what) {
  std::string list;
  for (const auto& [name, value] : known) {
    if (name == word) return value;
    list += (list.empty() ? "'" : ", '") + name + "'";
  }
  throw Error(ErrorCode::invalid_argument,
              std::string(what) + " must be one of " + list + ", not '" + word + "'");
}

OnConflict conflict_from(const std::string& word) {
  return choose<OnConflict>(word,
                            {{"refuse", OnConflict::refuse},
                             {"replace", OnConflict::replace},
                             {"merge", OnConflict::merge}},
                            "on_conflict");
}

/// The store while it is open.
class PyStore {
 public:
  PyStore(const std::filesystem::path& location, const std::string& access)
      : store_(without_gil([&, wanted = choose<Access>(access,
                                                       {{"create", Access::create},
                                                        {"existing", Access::existing},
                                                        {"read_only", Access::read_only}},
                                                       "access")] {
          return std::shared_ptr<ObjectStore>(open_store(location.string(), wanted));
        })) {}

  /// A pointer of its own: another thread may close the store meanwhile.
  std::shared_ptr<ObjectStore> get() const {
    if (!store_) throw Error(ErrorCode::io, "this database is closed");
    return store_;
  }
  void close() { store_.reset(); }
  bool is_open() const { return store_ != nullptr; }

 private:
  std::shared_ptr<ObjectStore> store_;
};

/// Calls `work` with the store while other threads run.
template <class Work>
auto with(const PyStore& self, Work work) {
  const auto store = self.get();
  return without_gil([&] { return work(*store); });
}

PyModels load(const PyStore& self, bool pictures) {
  return with(self, [&](ObjectStore& store) {
    LoadOptions options;
    options.pictures = pictures;
    PyModels models{store.load(options), store.features()};
    if (models.models->views().empty() && models.models->impostors().empty()) models.record.reset();
    return models;
  });
}

TeachOptions options_for(const ObjectStore& store, const py::kwargs& keywords) {
  TeachOptions options;
  if (const auto record = store.features()) options.feature = recorded_options(*record);
  apply_keywords(list_options(options), keywords);
  return options;
}

AddResult teach_into(const PyStore& self, const std::string& name, const py::object& picture,
                     const py::object& background, const py::object& mask, const py::object& roi,
                     const py::object& yaw_deg, const py::object& source,
                     const py::kwargs& keywords) {
  const TeachOptions options = options_for(*self.get(), keywords);
  PyView view = teach({picture, background, mask, roi, yaw_deg}, options, package_version());
  if (!source.is_none()) view.taught.provenance.source = source.cast<std::string>();
  return with(self,
              [&](ObjectStore& store) { return store.add_view(name, view.taught, view.record); });
}

void bind_reading(py::class_<PyStore, std::shared_ptr<PyStore>>& store) {
  store
      .def_property_readonly(
          "location", [](const PyStore& self) { return self.get()->location(); },
          "File name, or address without its password.")
      .def_property_readonly(
          "read_only",
          [](const PyStore& self) {
            return with(self, [](ObjectStore& s) { return s.read_only(); });
          },
          "Whether nothing may be added to it.")
      .def_property_readonly(
          "version",
          [](const PyStore& self) {
            return with(self, [](ObjectStore& s) { return s.version(); });
          },
          "Grows with every change, whichever program made it.")
      .def_property_readonly(
          "signature",
          [](const PyStore& self) -> py::object {
            const auto record = with(self, [](ObjectStore& s) { return s.features(); });
            return record ? py::object(py::str(record->signature)) : py::object(py::none());
          },
          "Kind of its features, e.g. 'surf64 1'; None while it is empty.")
      .def(
          "objects",
          [](const PyStore& self) { return with(self, [](ObjectStore& s) { return s.list(); }); },
          "objects() -> list[ObjectSummary]\n\n"
          "List of ObjectSummary, by name.")
      .def(
          "wait_for_change",
          [](const PyStore& self, std::int64_t known, double timeout_s) {
            const std::chrono::duration<double> timeout(std::clamp(timeout_s, 0.0, 1e6));
            return with(self, [&](ObjectStore& s) {
              return s.wait_for_change(
                  known, std::chrono::duration_cast<std::chrono::milliseconds>(timeout));
            });
          },
          py::arg("known"), py::arg("timeout_s"),
          "wait_for_change(known, timeout_s) -> bool\n\n"
          "Wait until `version` is no longer `known`, whichever program changes it; False when "
          "that\n"
          "does not happen within that many seconds. Other threads run meanwhile.")
      .def(
          "views",
          [](const PyStore& self, const std::string& name) {
            return with(self, [&](ObjectStore& s) { return s.views(name); });
          },
          py::arg("name"),
          "views(name) -> list[ViewSummary]\n\n"
          "List of ViewSummary, as they were taught. Raises NotFoundError.")
      .def(
          "view",
          [](const PyStore& self, const std::string& name, const std::string& id) {
            return with(self, [&](ObjectStore& s) {
              auto view = std::make_shared<PyView>();
              view->taught = s.view(name, id);
              view->record = s.features().value_or(FeatureRecord());
              return view;
            });
          },
          py::arg("name"), py::arg("id"),
          "view(name, id) -> View\n\n"
          "One View with its features. Raises NotFoundError.")
      .def(
          "load", &load, py::kw_only(), py::arg("pictures") = false,
          "load(*, pictures=False) -> ModelSet\n\n"
          "One consistent ModelSet of everything, for Recognizer. pictures: with View.picture and\n"
          "View.mask.")
      .def("__repr__", [](const PyStore& self) {
        return self.is_open() ? "ObjectStore('" + self.get()->location() + "')"
                              : std::string("ObjectStore(closed)");
      });
}

void bind_writing(py::class_<PyStore, std::shared_ptr<PyStore>>& store) {
  store
      .def(
          "teach", &teach_into, py::arg("name"), py::arg("picture"), py::kw_only(),
          py::arg("background") = py::none(), py::arg("mask") = py::none(),
          py::arg("roi") = py::none(), py::arg("yaw_deg") = py::none(),
          py::arg("source") = py::none(),
          "teach(name, picture, *, background=None, mask=None, roi=None, yaw_deg=None, "
          "source=None, **options) -> AddResult\n\n"
          "teach_view() and add_view() in one, with the kind of features that the database holds.\n"
          "source: where the picture comes from; default: the file's name. Returns AddResult.")
      .def(
          "add_view",
          [](const PyStore& self, const std::string& name, const PyView& view) {
            return with(self,
                        [&](ObjectStore& s) { return s.add_view(name, view.taught, view.record); });
          },
          py::arg("name"), py::arg("view"),
          "add_view(name, view) -> AddResult\n\n"
          "Add a View to the object of that name, which is made if it is new. The same picture "
          "with\n"
          "the same mask and yaw is stored once. Returns AddResult. Raises FeatureMismatchError.")
      .def(
          "remove_object",
          [](const PyStore& self, const std::string& name) {
            with(self, [&](ObjectStore& s) { s.remove_object(name); });
          },
          py::arg("name"),
          "remove_object(name) -> None\n\n"
          "Raises NotFoundError.")
      .def(
          "remove_view",
          [](const PyStore& self, const std::string& name, const std::string& id) {
            with(self, [&](ObjectStore& s) { s.remove_view(name, id); });
          },
          py::arg("name"), py::arg("id"),
          "remove_view(name, id) -> None\n\n"
          "Removing the last view removes the object. Raises NotFoundError.")
      .def(
          "rename_object",
          [](const PyStore& self, const std::string& name, const std::string& to) {
            with(self, [&](ObjectStore& s) { s.rename_object(name, to); });
          },
          py::arg("name"), py::arg("to"),
          "rename_object(name, to) -> None\n\n"
          "Raises NotFoundError, AlreadyExistsError.")
      .def(
          "transact",
          [](const PyStore& self, const std::function<void()>& work) {
            with(self, [&](ObjectStore& s) { s.transact(work); });
          },
          py::arg("work"),
          "transact(work) -> None\n\n"
          "Make all changes that `work()` makes through this store one change: an exception "
          "undoes\n"
          "them all.")
      .def(
          "copy_from",
          [](const PyStore& self, const PyStore& other, const std::vector<std::string>& names,
             const std::string& on_conflict) {
            const OnConflict rule = conflict_from(on_conflict);
            const auto from = other.get();
            return with(self, [&](ObjectStore& s) { return copy_objects(*from, s, names, rule); });
          },
          py::arg("other"), py::arg("names") = std::vector<std::string>(), py::kw_only(),
          py::arg("on_conflict") = "refuse",
          "copy_from(other, names=[], *, on_conflict='refuse') -> TransferResult\n\n"
          "Copy objects (none named: all) from another database as one change. on_conflict:\n"
          "'refuse' names that are taken, 'replace' those objects, or 'merge' the views.")
      .def(
          "export",
          [](const PyStore& self, const std::filesystem::path& path,
             const std::vector<std::string>& names, bool overwrite) {
            return with(self, [&](ObjectStore& s) {
              return export_objects(s, path.string(), names, overwrite);
            });
          },
          py::arg("path"), py::arg("names") = std::vector<std::string>(), py::kw_only(),
          py::arg("overwrite") = false,
          "export(path, names=[], *, overwrite=False) -> TransferResult\n\n"
          "Write objects (none named: all) into a new file, which ObjectStore opens.");
}

}  // namespace

void bind_store(py::module_& module) {
  module.def("_without_passwords", [](const std::string& text) { return without_passwords(text); });
  py::class_<PyStore, std::shared_ptr<PyStore>> store(
      module, "ObjectStore",
      "A database of taught objects.\n\n"
      "location: a SQLite file, or postgresql://... where the build has it.\n"
      "access: 'create' it when it is not there, open an 'existing' one, or 'read_only'.\n\n"
      "Safe to use from many threads and programs at once; every change is all or nothing. Use it\n"
      "in a with statement, or close() it.");
  store.def(py::init<const std::filesystem::path&, const std::string&>(), py::arg("location"),
            py::arg("access") = "create");
  bind_reading(store);
  bind_writing(store);
  store
      .def("close", &PyStore::close,
           "close() -> None\n\n"
           "Further calls raise IoError.")
      .def("__enter__", [](const py::object& self) { return self; })
      .def("__exit__", [](PyStore& self, const py::args&) { self.close(); });
}

}  // namespace posevote::python
