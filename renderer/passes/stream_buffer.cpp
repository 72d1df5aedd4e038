#include <algorithm>

#include "renderer/passes/scene_pass.h"

namespace cupola::passes {

namespace {
constexpr GLuint64 a_second = 1'000'000'000;
}

std::byte* StreamBuffer::begin(std::size_t bytes) {
  current_ = (current_ + 1) % segments_.size();
  Segment& segment = segments_[current_];
  while (!segment.fence.ended(a_second)) {}
  segment.fence = {};
  if (bytes > segment.size) {
    segment.size = std::max<std::size_t>(bytes + bytes / 2, 1u << 20);
    segment.buffer = gl::Buffer::make();
    constexpr GLbitfield flags = GL_MAP_WRITE_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
    const auto size = static_cast<GLsizeiptr>(segment.size);
    glNamedBufferStorage(segment.buffer.id(), size, nullptr, flags);
    segment.mapped = static_cast<std::byte*>(glMapNamedBufferRange(segment.buffer.id(), 0, size, flags));
  }
  return segment.mapped;
}

void StreamBuffer::finish() { segments_[current_].fence = gl::Fence::insert(); }

std::size_t StreamBuffer::bytes() const {
  std::size_t sum = 0;
  for (const Segment& segment : segments_) sum += segment.size;
  return sum;
}

} // namespace cupola::passes
