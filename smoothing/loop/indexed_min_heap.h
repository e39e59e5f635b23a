#pragma once

#include <cassert>
#include <cstdint>
#include <vector>

namespace smoothfem {

/// A binary min heap of the numbers 0 .. n-1 by key, whose keys can change: lowest key first, ties
/// by number. Members are those given a key by build(); others are not in the heap.
class IndexedMinHeap {
 public:
  /// keys: one for each number; members: the numbers in the heap, each once.
  void build(std::vector<double> keys, std::vector<std::uint32_t> members) {
    keys_ = std::move(keys);
    heap_ = std::move(members);
    places_.assign(keys_.size(), absent);
    for (std::size_t place = 0; place < heap_.size(); ++place)
      places_[heap_[place]] = static_cast<std::uint32_t>(place);
    for (std::size_t place = heap_.size() / 2; place-- > 0;) sift_down(place);
  }

  bool empty() const { return heap_.empty(); }
  std::uint32_t top() const {
    assert(!empty());
    return heap_.front();
  }
  bool contains(std::uint32_t number) const { return places_[number] != absent; }

  void update(std::uint32_t number, double key) {
    assert(contains(number));
    keys_[number] = key;
    sift_down(sift_up(places_[number]));
  }

 private:
  static constexpr std::uint32_t absent = UINT32_MAX;

  bool before(std::uint32_t a, std::uint32_t b) const {
    return keys_[a] < keys_[b] || (keys_[a] == keys_[b] && a < b);
  }
  void place(std::uint32_t number, std::size_t where) {
    heap_[where] = number;
    places_[number] = static_cast<std::uint32_t>(where);
  }
  std::size_t sift_up(std::size_t where) {
    const std::uint32_t number = heap_[where];
    while (where > 0 && before(number, heap_[(where - 1) / 2])) {
      place(heap_[(where - 1) / 2], where);
      where = (where - 1) / 2;
    }
    place(number, where);
    return where;
  }
  void sift_down(std::size_t where) {
    const std::uint32_t number = heap_[where];
    for (std::size_t child = 2 * where + 1; child < heap_.size(); child = 2 * where + 1) {
      if (child + 1 < heap_.size() && before(heap_[child + 1], heap_[child])) ++child;
      if (!before(heap_[child], number)) break;
      place(heap_[child], where);
      where = child;
    }
    place(number, where);
  }

  std::vector<double> keys_;
  std::vector<std::uint32_t> heap_;
  std::vector<std::uint32_t> places_;
};

}  // namespace smoothfem
