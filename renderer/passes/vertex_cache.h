// Emitted vertices of a batch that a neighbour may use again: a table of the latest of each slot. One thread.
#pragma once

#include <array>
#include <cstdint>

namespace cupola::passes {

class VertexCache {
public:
  struct Key {
    std::uint32_t a, b, c, d;
    bool operator==(const Key&) const = default;
  };
  /// The slot of a key: a hit when its key and batch are the same.
  struct Entry {
    Key key{};
    std::uint32_t batch = ~0u;
    std::uint32_t emitted = 0;
  };
  Entry& at(const Key& key) {
    const std::uint32_t hash =
        key.a * 2654435761u ^ key.b * 2246822519u ^ key.c * 3266489917u ^ key.d * 668265263u;
    return entries_[(hash ^ hash >> 15) & (entries_.size() - 1)];
  }

private:
  std::array<Entry, 8192> entries_{};
};

} // namespace cupola::passes
