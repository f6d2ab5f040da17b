// The bytes of Index::save: "PVIX", version, signature, dimension, the centres of each sign, the
// lists of each unit by its key, and a checksum of all before. Numbers are little-endian.
#include "posevote/core/bytes.hpp"
#include "posevote/index/list_index.hpp"

namespace posevote {
namespace {

constexpr std::uint32_t kVersion = 1;  // raise it when the codes or the layout change

}  // namespace

std::uint64_t saved_key(const Unit& unit) {
  if (unit.view && !unit.view->hash.empty())
    return hash_bytes(unit.view->hash.data(), unit.view->hash.size());
  std::uint64_t hash = hash_bytes(reinterpret_cast<const char*>(unit.signs.data()), unit.size());
  for (int i = 0; i < unit.descriptors.rows; ++i)
    hash = hash_bytes(unit.descriptors.ptr<char>(i),
                      unit.descriptors.elemSize() * static_cast<std::size_t>(unit.descriptors.cols),
                      hash);
  return hash;
}

std::string ListIndex::save() const {
  ByteWriter out;
  out.value(std::uint32_t{0x58495650});  // "PVIX"
  out.value(kVersion);
  out.array(signature_.data(), signature_.size());
  out.value(static_cast<std::uint32_t>(coder_.dimension()));
  for (std::size_t sign = 0; sign < kSigns; ++sign) {
    const Centers centers = quantizer_ ? (*quantizer_)[sign] : Centers();
    out.value(static_cast<std::uint32_t>(centers.count()));
    out.value(centers.member_scale());
    out.array(centers.codes().data(), centers.codes().size());
  }
  std::uint32_t units = 0;
  for (const Part& part : parts_)
    for (const Number& number : part.numbers) units += number.present;
  out.value(units);
  for (const Part& part : parts_)
    for (std::size_t u = 0; u < part.numbers.size(); ++u) {
      if (!part.numbers[u].present) continue;
      const Unit& unit = part.segment->units()[u];
      out.value(saved_key(unit));
      out.array(unit.lists.data(), unit.lists.size());
    }
  return out.finish();
}

SavedLists read_saved(const std::string& bytes, const std::string& signature, const Coder& coder) {
  if (!is_whole(bytes)) return {};
  ByteReader in(bytes);
  if (in.value<std::uint32_t>() != 0x58495650 || in.value<std::uint32_t>() != kVersion) return {};
  if (in.array<std::string>() != signature) return {};
  if (in.value<std::uint32_t>() != static_cast<std::uint32_t>(coder.dimension())) return {};
  auto quantizer = std::make_shared<Quantizer>();
  for (Centers& centers : *quantizer) {
    const std::size_t count = in.value<std::uint32_t>();
    const auto member_scale = in.value<float>();
    auto codes = in.array<std::vector<std::uint8_t>>();
    const std::size_t blocks = (count + kBlockLanes - 1) / kBlockLanes;
    if (count > 65536 || codes.size() != blocks * coder.block_bytes()) return {};
    if (!(member_scale >= kUnitScale && member_scale < 1e6F)) return {};
    centers = Centers(coder, count, std::move(codes), member_scale);
  }
  SavedLists result;
  const std::uint32_t units = in.value<std::uint32_t>();
  for (std::uint32_t u = 0; u < units && in.good(); ++u) {
    const auto key = in.value<std::uint64_t>();
    result.units[key] = in.array<std::vector<std::uint16_t>>();
  }
  if (in.good()) result.quantizer = std::move(quantizer);
  return result;
}

}  // namespace posevote
