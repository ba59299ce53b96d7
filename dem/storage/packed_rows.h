#pragma once

#include "base/page_allocator.h"
#include "base/simd.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <utility>
#include <vector>

namespace feldspar
{
/// Gives back the room of a list beyond its end if that is a tenth or more; for less it is not worth a copy.
template <typename List>
void give_back_room(List& list)
{
  constexpr double largest_share = 0.9;
  if (double(list.size()) < largest_share * double(list.capacity()))
    list.shrink_to_fit();
}

/// A table of numbers with a column for each of many things, stored `width` columns at a time: all rows of the first ones,
/// then all rows of the next. Who walks through the columns follows one stream, however many rows there are.
template <std::size_t width>
class PackedTable
{
public:
  /// All zero.
  void resize(const std::size_t rows, const std::size_t columns)
  {
    row_count = rows;
    column_count = columns;
    values.assign((columns + width - 1) / width * width * rows, 0.0);
  }

  /// Drops every column that is not among `kept` (ascending).
  void keep(const std::vector<std::size_t>& kept)
  {
    for (std::size_t to = 0; to < kept.size(); ++to)
      for (std::size_t row = 0; row < row_count; ++row)
        *at(row, to) = *at(row, kept[to]);
    column_count = kept.size();
    values.resize((column_count + width - 1) / width * width * row_count);
    give_back_room(values);
  }

  /// Makes column k what column order[k] was; a permutation of all.
  void reorder(const std::vector<std::size_t>& order)
  {
    std::vector<double> numbers(order.size());
    for (std::size_t row = 0; row < row_count; ++row)
      {
        for (std::size_t k = 0; k < order.size(); ++k)
          numbers[k] = *at(row, order[k]);
        for (std::size_t k = 0; k < order.size(); ++k)
          *at(row, k) = numbers[k];
      }
  }

  std::size_t n_rows() const { return row_count; }
  std::size_t n_columns() const { return column_count; }

  /// The rest of the column's pack follows.
  double* at(const std::size_t row, const std::size_t column) { return values.data() + place(row, column); }
  const double* at(const std::size_t row, const std::size_t column) const { return values.data() + place(row, column); }

private:
  std::size_t place(const std::size_t row, const std::size_t column) const
  {
    return (column / width * row_count + row) * width + column % width;
  }

  std::size_t row_count = 0, column_count = 0;
  LargeVector<double> values;
};

/// Width of a table whose rows are read by packs, for a sweep.
inline constexpr std::size_t pack_width = simd::width<simd::Pack>;

/// A row of a table as if it were an array of its own; or every `stride`-th row, one after the other.
template <std::size_t width>
class TableRow
{
public:
  TableRow(PackedTable<width>& of, const std::size_t row, const std::size_t row_stride = 0)
    : table(of)
    , first(row)
    , stride(row_stride)
  {
  }
  TableRow(const TableRow&) = delete; // it would be another name for the same numbers
  TableRow& operator=(const TableRow&) = delete;

  std::size_t size() const { return table.n_columns() * (stride > 0 ? table.n_rows() / stride : 1); }

  double& operator[](const std::size_t i) { return *place(i); }
  const double& operator[](const std::size_t i) const { return *place(i); }

  /// Column j of the row or, of several, of the i-th. The rest of its pack follows, then that of the next row.
  double* pack(const std::size_t j) { return table.at(first, j); }
  const double* pack(const std::size_t j) const { return table.at(first, j); }
  double* pack(const std::size_t i, const std::size_t j) { return table.at(first + i * stride, j); }
  const double* pack(const std::size_t i, const std::size_t j) const { return table.at(first + i * stride, j); }

  template <typename Row, typename Value>
  class Iterator
  {
  public:
    using iterator_category = std::random_access_iterator_tag;
    using value_type = double;
    using difference_type = std::ptrdiff_t;
    using pointer = Value*;
    using reference = Value&;

    Iterator() = default;
    Iterator(Row* of, const std::size_t at)
      : row(of)
      , i(at)
    {
    }
    reference operator*() const { return (*row)[i]; }
    reference operator[](const difference_type n) const { return (*row)[i + std::size_t(n)]; }
    Iterator& operator+=(const difference_type n)
    {
      i += std::size_t(n);
      return *this;
    }
    Iterator& operator-=(const difference_type n) { return *this += -n; }
    Iterator& operator++() { return *this += 1; }
    Iterator& operator--() { return *this -= 1; }
    Iterator operator++(int) { return {row, i++}; }
    Iterator operator--(int) { return {row, i--}; }
    friend Iterator operator+(Iterator at, const difference_type n) { return at += n; }
    friend Iterator operator+(const difference_type n, Iterator at) { return at += n; }
    friend Iterator operator-(Iterator at, const difference_type n) { return at -= n; }
    friend difference_type operator-(const Iterator& a, const Iterator& b)
    {
      return difference_type(a.i) - difference_type(b.i);
    }
    friend bool operator==(const Iterator& a, const Iterator& b) { return a.i == b.i; }
    friend auto operator<=>(const Iterator& a, const Iterator& b) { return a.i <=> b.i; }

  private:
    Row* row = nullptr;
    std::size_t i = 0;
  };
  using value_type = double;
  using iterator = Iterator<TableRow, double>;
  using const_iterator = Iterator<const TableRow, const double>;
  iterator begin() { return {this, 0}; }
  iterator end() { return {this, size()}; }
  const_iterator begin() const { return {this, 0}; }
  const_iterator end() const { return {this, size()}; }

  friend bool operator==(const TableRow& a, const TableRow& b)
  {
    return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin());
  }

private:
  double* place(const std::size_t i) const
  {
    if (stride == 0)
      return table.at(first, i);
    const std::size_t n = table.n_columns();
    return table.at(first + i / n * stride, i % n);
  }

  PackedTable<width>& table;
  std::size_t first, stride;
};

using PackedRows = PackedTable<pack_width>;
using PackedRow = TableRow<pack_width>;

/// Row by row of a table, as the components of a vector.
template <std::size_t n, std::size_t width = pack_width>
using PackedComponents = std::array<TableRow<width>, n>;

template <std::size_t n, std::size_t width>
PackedComponents<n, width> packed_components(PackedTable<width>& table, const std::size_t first,
                                             const std::size_t stride = 0)
{
  return [&]<std::size_t... c>(std::index_sequence<c...>)
  {
    return PackedComponents<n, width>{TableRow<width>(table, first + c, stride)...};
  }
  (std::make_index_sequence<n>());
}
} // namespace feldspar
