#include "posevote/recognize/prepared.hpp"

#include <unordered_map>

#include "posevote/core/bytes.hpp"

namespace posevote {
namespace {

constexpr std::uint32_t kMagic = 0x52505650;  // "PVPR"
constexpr std::uint32_t kVersion = 1;

/// 0: cannot be known again.
std::uint64_t key_of(const ObjectModel& object) {
  std::uint64_t key = hash_bytes(nullptr, 0);
  for (const auto& view : object.views) {
    if (view->hash.empty()) return 0;
    key = hash_bytes(view->hash.data(), view->hash.size(), key);
  }
  return key;
}

/// The objects of `models` in the order of `keys`, and where each stands in it.
struct Known {
  std::vector<ObjectModel> objects;
  std::vector<std::size_t> places;
};

Known find_known(const std::vector<std::uint64_t>& keys, const ModelSet& models) {
  std::unordered_map<std::uint64_t, const ObjectModel*> by_key;
  for (const ObjectModel& object : models.objects()) by_key[key_of(object)] = &object;
  Known known;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const auto found = keys[i] == 0 ? by_key.end() : by_key.find(keys[i]);
    if (found == by_key.end()) continue;
    known.objects.push_back(*found->second);
    known.places.push_back(i);
    by_key.erase(found);
  }
  return known;
}

}  // namespace

std::string save_prepared(const Index& index, const LookAlikes& look_alikes) {
  ByteWriter out;
  out.value(kMagic);
  out.value(kVersion);
  const std::string of_index = index.save();
  out.array(of_index.data(), of_index.size());
  std::vector<std::uint64_t> keys;
  std::vector<std::uint32_t> pairs;  // row * objects + column of what is not 0
  if (look_alikes.models)
    for (const ObjectModel& object : look_alikes.models->objects()) keys.push_back(key_of(object));
  for (std::size_t i = 0; i < look_alikes.table.size(); ++i)
    if (look_alikes.table[i] != 0) pairs.push_back(static_cast<std::uint32_t>(i));
  out.array(keys.data(), keys.size());
  out.array(pairs.data(), pairs.size());
  return out.finish();
}

Prepared read_prepared(const std::string& bytes, const ModelSet& models) {
  Prepared result;
  if (!is_whole(bytes)) return result;
  ByteReader in(bytes);
  if (in.value<std::uint32_t>() != kMagic || in.value<std::uint32_t>() != kVersion) return result;
  result.index = in.array<std::string>();
  const auto keys = in.array<std::vector<std::uint64_t>>();
  const auto pairs = in.array<std::vector<std::uint32_t>>();
  if (!in.good() || keys.empty()) return result;
  Known known = find_known(keys, models);
  std::vector<char> saved(keys.size() * keys.size(), 0);
  for (const std::uint32_t pair : pairs)
    if (pair < saved.size()) saved[pair] = 1;
  const auto& places = known.places;
  for (const std::size_t a : places)
    for (const std::size_t b : places)
      result.look_alikes.table.push_back(saved[a * keys.size() + b]);
  result.look_alikes.models =
      std::make_shared<const ModelSet>(models.signature(), std::move(known.objects));
  return result;
}

}  // namespace posevote
