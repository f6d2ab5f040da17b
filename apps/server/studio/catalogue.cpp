#include "studio/catalogue.hpp"

#include <algorithm>

#include "prepared_recognizer.hpp"

namespace posevote::server {

Catalogue::Catalogue(std::unique_ptr<ObjectStore> store, const Settings& settings, Bell& bell)
    : store_(std::move(store)), settings_(settings), bell_(bell) {
  refresh();
}

FeatureOptions Catalogue::features() const {
  const auto record = store_->features();
  return record ? recorded_options(*record) : settings_.options().recognize.feature;
}

TeachOptions Catalogue::teach_options() const {
  TeachOptions options = settings_.options().teach;
  options.feature = features();
  return options;
}

void Catalogue::refresh() {
  const std::lock_guard one(refreshing_);
  const std::int64_t version =
      store_->version();  // read first: what comes later is loaded next time
  const int generation = settings_.generation();
  if (version == version_ && generation == generation_) return;
  RecognizeOptions options = settings_.options().recognize;
  options.feature = features();
  const auto models = store_->load();
  if (recognizer_ && generation == generation_ &&
      options.feature.signature() == recognizer_->options().feature.signature()) {
    recognizer_->set_models(models);
  } else {
    std::shared_ptr<Recognizer> made = make_recognizer(*store_, version, models, options);
    const std::lock_guard lock(mutex_);
    recognizer_ = std::move(made);
  }
  {
    const std::lock_guard lock(mutex_);
    version_ = version;
    generation_ = generation;
  }
  bell_.ring();
}

std::shared_ptr<const Recognizer> Catalogue::recognizer() const {
  const std::lock_guard lock(mutex_);
  return recognizer_;
}

std::int64_t Catalogue::version() const {
  const std::lock_guard lock(mutex_);
  return version_;
}

std::vector<AddResult> copy_views(const ObjectStore& from, const std::string& from_name,
                                  ObjectStore& to, const std::string& to_name) {
  std::vector<AddResult> results;
  to.transact([&] {
    const auto features = from.features();
    for (const ViewSummary& summary : from.views(from_name))
      results.push_back(to.add_view(to_name, from.view(from_name, summary.id), features.value()));
  });
  return results;
}

bool has_object(const ObjectStore& store, const std::string& name) {
  const auto objects = store.list();
  return std::ranges::find(objects, name, &ObjectSummary::name) != objects.end();
}

}  // namespace posevote::server
