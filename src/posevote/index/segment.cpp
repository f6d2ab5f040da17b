#include "posevote/index/segment.hpp"

#include <algorithm>
#include <cmath>

namespace posevote {

void assign_lists(const Coder& coder, const Quantizer& quantizer, std::vector<Unit>& units,
                  int threads) {
  std::array<std::vector<Segment::Entry>, kSigns> rows;
  for (std::size_t u = 0; u < units.size(); ++u) {
    Unit& unit = units[u];
    if (unit.lists.size() == unit.size()) continue;
    unit.lists.resize(unit.size());
    for (std::size_t i = 0; i < unit.size(); ++i)
      rows[sign_class(unit.signs[i])].push_back(
          {static_cast<std::uint32_t>(u), static_cast<std::uint32_t>(i)});
  }
  for (std::size_t sign = 0; sign < kSigns; ++sign) {
    std::vector<std::uint16_t> lists(rows[sign].size());
    quantizer[sign].assign(
        coder, lists.size(),
        [&](std::size_t i, std::vector<float>& buffer) {
          const Segment::Entry& entry = rows[sign][i];
          return read_row(units[entry.unit].descriptors, static_cast<int>(entry.feature), buffer);
        },
        lists.data(), threads);
    for (std::size_t i = 0; i < lists.size(); ++i)
      units[rows[sign][i].unit].lists[rows[sign][i].feature] = lists[i];
  }
}

Segment::Segment(const Coder& coder, const Quantizer& quantizer, std::vector<Unit> units)
    : units_(std::move(units)) {
  for (std::size_t sign = 0; sign < kSigns; ++sign) fill(coder, quantizer[sign], sign);
  for (const Unit& unit : units_) size_ += unit.size();
}

void Segment::fill(const Coder& coder, const Centers& centers, std::size_t sign) {
  Lists& lists = lists_[sign];
  std::vector<std::uint32_t> next(
      centers.lists());  // first the number of codes, then the next place
  for (const Unit& unit : units_)
    for (std::size_t i = 0; i < unit.size(); ++i)
      if (sign_class(unit.signs[i]) == sign) ++next[unit.lists[i]];
  lists.sizes = next;
  lists.starts.push_back(0);
  for (std::uint32_t& count : next) {
    const std::uint32_t start = lists.starts.back();
    lists.starts.push_back(start +
                           static_cast<std::uint32_t>((count + kBlockLanes - 1) / kBlockLanes));
    count = start * static_cast<std::uint32_t>(kBlockLanes);
  }
  lists.entries.assign(lists.starts.back() * kBlockLanes, {kNone, 0});
  for (std::size_t u = 0; u < units_.size(); ++u)
    for (std::size_t i = 0; i < units_[u].size(); ++i)
      if (sign_class(units_[u].signs[i]) == sign)
        lists.entries[next[units_[u].lists[i]]++] = {static_cast<std::uint32_t>(u),
                                                     static_cast<std::uint32_t>(i)};
  // Written list by list, so that the codes are touched in order.
  lists.codes.assign(lists.starts.back() * coder.block_bytes(), 128);
  std::vector<float> buffer;
  for (std::size_t i = 0; i < lists.entries.size(); ++i) {
    const Entry& entry = lists.entries[i];
    if (entry.unit == kNone) continue;
    const float* row =
        read_row(units_[entry.unit].descriptors, static_cast<int>(entry.feature), buffer);
    const float residual = coder.encode_taught(
        row, centers.center(units_[entry.unit].lists[entry.feature]), centers.member_scale(),
        &lists.codes[i / kBlockLanes * coder.block_bytes()], i % kBlockLanes);
    largest_residual_ = std::max(largest_residual_, residual);
    squared_residuals_ += residual * residual;
  }
}

float Segment::usual_residual() const noexcept {
  return size_ == 0
             ? 0.0F
             : static_cast<float>(std::sqrt(squared_residuals_ / static_cast<double>(size_)));
}

std::size_t Segment::bytes() const noexcept {
  std::size_t sum = 0;
  for (const Lists& lists : lists_)
    sum += lists.codes.capacity() + lists.entries.capacity() * sizeof(Entry) +
           (lists.starts.capacity() + lists.sizes.capacity()) * sizeof(std::uint32_t);
  for (const Unit& unit : units_)
    sum += sizeof(Unit) + unit.signs.capacity() + unit.lists.capacity() * sizeof(std::uint16_t);
  return sum;
}

}  // namespace posevote
