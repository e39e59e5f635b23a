// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/ranks/ranks.h"

#include <deal.II/base/aligned_vector.h>
#include <deal.II/base/partitioner.h>

#include <algorithm>
#include <limits>

#include "smoothing/base/input_error.h"

namespace smoothfem {

namespace {

/// MPI type of an item. Counts and offsets are then in items instead of bytes, so that an int holds
/// larger arrays.
class ItemType {
 public:
  explicit ItemType(std::size_t size) {
    MPI_Type_contiguous(static_cast<int>(size), MPI_BYTE, &type_);
    MPI_Type_commit(&type_);
  }
  ~ItemType() { MPI_Type_free(&type_); }
  ItemType(const ItemType&) = delete;
  ItemType& operator=(const ItemType&) = delete;
  MPI_Datatype get() const { return type_; }

 private:
  MPI_Datatype type_{};
};

/// Returns the offsets of each rank's items.
std::vector<int> offsets_of(const std::vector<int>& counts) {
  std::vector<int> offsets(counts.size());
  std::exclusive_scan(counts.begin(), counts.end(), offsets.begin(), 0);
  return offsets;
}

/// Merges two ascending lists of cells and keeps as many as one has; an operation of MPI.
void merge_lowest(void* in, void* in_and_out, int* n_lists, MPI_Datatype* type) {
  int n_bytes = 0;
  MPI_Type_size(*type, &n_bytes);
  const std::size_t n = static_cast<std::size_t>(n_bytes) / sizeof(KeyedCell);
  const auto* from = static_cast<const KeyedCell*>(in);
  auto* to = static_cast<KeyedCell*>(in_and_out);
  std::vector<KeyedCell> merged(2 * n);
  for (int i = 0; i < *n_lists; ++i, from += n, to += n) {
    std::merge(from, from + n, to, to + n, merged.begin());
    std::copy_n(merged.begin(), n, to);
  }
}

}  // namespace

Ranks::Ranks(MPI_Comm communicator) : communicator_(communicator) {
  MPI_Comm_size(communicator, &size_);
  MPI_Comm_rank(communicator, &rank_);
}

void Ranks::on_root(const std::function<void()>& work) const {
  std::exception_ptr error;
  try {
    if (is_root()) work();
  } catch (const InputError&) {
    error = std::current_exception();
  }
  bool refused = error != nullptr;
  broadcast(refused);
  if (error) std::rethrow_exception(error);
  if (refused)
    throw InputError(
        "the problem cannot be solved on the mesh; see the error of the first process");
}

void Ranks::together(const std::function<void()>& work) const {
  std::string error;
  bool failed = false;
  try {
    work();
  } catch (const InputError& found) {
    error = found.what();
    failed = true;
  }
  double first = failed ? rank_ : size_;
  min({&first, 1});
  const int source = static_cast<int>(first);
  if (source == size_) return;
  int length = static_cast<int>(error.size());
  if (size_ > 1) {
    MPI_Bcast(&length, 1, MPI_INT, source, communicator_);
    error.resize(static_cast<std::size_t>(length));
    MPI_Bcast(error.data(), length, MPI_CHAR, source, communicator_);
  }
  throw InputError(error);
}

void Ranks::sum(std::span<double> values) const {
  if (size_ > 1)
    MPI_Allreduce(MPI_IN_PLACE, values.data(), static_cast<int>(values.size()), MPI_DOUBLE, MPI_SUM,
                  communicator_);
}

void Ranks::sum(std::span<std::int64_t> values) const {
  if (size_ > 1)
    MPI_Allreduce(MPI_IN_PLACE, values.data(), static_cast<int>(values.size()), MPI_INT64_T,
                  MPI_SUM, communicator_);
}

void Ranks::min(std::span<double> values) const {
  if (size_ > 1)
    MPI_Allreduce(MPI_IN_PLACE, values.data(), static_cast<int>(values.size()), MPI_DOUBLE, MPI_MIN,
                  communicator_);
}

void Ranks::max(std::span<double> values) const {
  if (size_ > 1)
    MPI_Allreduce(MPI_IN_PLACE, values.data(), static_cast<int>(values.size()), MPI_DOUBLE, MPI_MAX,
                  communicator_);
}

double Ranks::sum(double value) const {
  sum({&value, 1});
  return value;
}

std::size_t Ranks::sum(std::size_t value) const {
  if (size_ > 1) MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_UINT64_T, MPI_SUM, communicator_);
  return value;
}

double Ranks::max(double value) const {
  max({&value, 1});
  return value;
}

std::vector<std::byte> Ranks::gather_all_bytes(std::span<const std::byte> bytes) const {
  if (size_ == 1) return {bytes.begin(), bytes.end()};
  std::vector<int> counts(static_cast<std::size_t>(size_));
  const int count = static_cast<int>(bytes.size());
  MPI_Allgather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, communicator_);
  const auto offsets = offsets_of(counts);
  std::vector<std::byte> all(static_cast<std::size_t>(offsets.back() + counts.back()));
  MPI_Allgatherv(bytes.data(), count, MPI_BYTE, all.data(), counts.data(), offsets.data(), MPI_BYTE,
                 communicator_);
  return all;
}

void Ranks::keep_lowest(std::span<KeyedCell> cells) const {
  if (size_ == 1 || cells.empty()) return;
  const ItemType type(cells.size_bytes());
  MPI_Op lowest;
  MPI_Op_create(merge_lowest, 1, &lowest);
  MPI_Allreduce(MPI_IN_PLACE, cells.data(), 1, type.get(), lowest, communicator_);
  MPI_Op_free(&lowest);
}

std::size_t Ranks::exclusive_scan(std::size_t value) const {
  std::size_t before = 0;
  if (size_ > 1) MPI_Exscan(&value, &before, 1, MPI_UINT64_T, MPI_SUM, communicator_);
  return is_root() ? 0 : before;  // MPI leaves the root's value undefined
}

void Ranks::broadcast_bytes(void* bytes, std::size_t n_bytes) const {
  if (size_ > 1) MPI_Bcast(bytes, static_cast<int>(n_bytes), MPI_BYTE, 0, communicator_);
}

std::vector<int> Ranks::gather_counts(std::size_t n_values) const {
  std::vector<int> counts(is_root() ? static_cast<std::size_t>(size_) : 0);
  const int count = static_cast<int>(n_values);
  MPI_Gather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, 0, communicator_);
  return counts;
}

void Ranks::gather_items(const void* values, const std::vector<int>& counts, std::size_t item_size,
                         void* all, std::size_t n_values) const {
  const ItemType type(item_size);
  const auto offsets = offsets_of(counts);
  MPI_Gatherv(values, static_cast<int>(n_values), type.get(), all, counts.data(), offsets.data(),
              type.get(), 0, communicator_);
}

void Ranks::scatter_items(const void* all, const std::vector<int>& counts, std::size_t item_size,
                          void* values, std::size_t n_values) const {
  const ItemType type(item_size);
  const auto offsets = offsets_of(counts);
  MPI_Scatterv(all, counts.data(), offsets.data(), type.get(), values, static_cast<int>(n_values),
               type.get(), 0, communicator_);
}

std::vector<std::size_t> Ranks::exchange_counts(const std::vector<std::size_t>& counts) const {
  std::vector<std::size_t> received(counts.size());
  MPI_Alltoall(counts.data(), 1, MPI_UINT64_T, received.data(), 1, MPI_UINT64_T, communicator_);
  return received;
}

void Ranks::exchange_items(const void* sent, const std::vector<std::size_t>& counts, void* received,
                           const std::vector<std::size_t>& received_counts,
                           std::size_t item_size) const {
  const ItemType type(item_size);
  constexpr std::size_t most = std::numeric_limits<int>::max();
  const auto total = [](const std::vector<std::size_t>& numbers) {
    return std::accumulate(numbers.begin(), numbers.end(), std::size_t{0});
  };
  if (any(std::max(total(counts), total(received_counts)) > most))
    throw InputError("a process would exchange more than 2^31 items; use more processes");
  const std::vector<int> n_sent(counts.begin(), counts.end()),
      n_received(received_counts.begin(), received_counts.end());
  const auto from = offsets_of(n_sent), to = offsets_of(n_received);
  MPI_Alltoallv(sent, n_sent.data(), from.data(), type.get(), received, n_received.data(),
                to.data(), type.get(), communicator_);
}

struct Halo::Partition {
  dealii::Utilities::MPI::Partitioner partitioner;
  mutable dealii::AlignedVector<double> sent;
  mutable std::vector<MPI_Request> requests;
};

namespace {

dealii::IndexSet index_set(std::size_t n_total, const std::vector<std::size_t>& indices) {
  dealii::IndexSet set(n_total);
  set.add_indices(indices.begin(), indices.end());
  return set;
}

dealii::IndexSet index_range(std::size_t n_total, std::size_t first, std::size_t n) {
  dealii::IndexSet set(n_total);
  set.add_range(first, first + n);
  return set;
}

}  // namespace

Halo::Halo(const Ranks& ranks, std::size_t n_total, std::size_t first_own, std::size_t n_own,
           const std::vector<std::size_t>& ghosts) {
  if (ranks.size() == 1 || n_total == 0) return;  // deal.II divides by the number of entries
  partition_ = std::make_shared<const Partition>(Partition{
      {index_range(n_total, first_own, n_own), index_set(n_total, ghosts), ranks.communicator()},
      {},
      {}});
  partition_->sent.resize(partition_->partitioner.n_import_indices());
}

void Halo::update(Eigen::VectorXd& values) const {
  if (!partition_) return;
  const auto& partitioner = partition_->partitioner;
  const std::size_t n_own = partitioner.locally_owned_size();
  const dealii::ArrayView<const double> own(values.data(), n_own);
  const dealii::ArrayView<double> ghosts(values.data() + n_own, partitioner.n_ghost_indices());
  const dealii::ArrayView<double> sent(partition_->sent.data(), partition_->sent.size());
  partitioner.export_to_ghosted_array_start<double, dealii::MemorySpace::Host>(
      0, own, sent, ghosts, partition_->requests);
  partitioner.export_to_ghosted_array_finish<double, dealii::MemorySpace::Host>(
      ghosts, partition_->requests);
}

void Halo::add_to_owners(Eigen::VectorXd& values) const {
  if (!partition_) return;
  const auto& partitioner = partition_->partitioner;
  const std::size_t n_own = partitioner.locally_owned_size();
  const dealii::ArrayView<double> own(values.data(), n_own);
  const dealii::ArrayView<double> ghosts(values.data() + n_own, partitioner.n_ghost_indices());
  const dealii::ArrayView<double> received(partition_->sent.data(), partition_->sent.size());
  partitioner.import_from_ghosted_array_start<double, dealii::MemorySpace::Host>(
      dealii::VectorOperation::add, 0, ghosts, received, partition_->requests);
  partitioner.import_from_ghosted_array_finish<double, dealii::MemorySpace::Host>(
      dealii::VectorOperation::add,
      dealii::ArrayView<const double>(received.data(), received.size()), own, ghosts,
      partition_->requests);
}

}  // namespace smoothfem
