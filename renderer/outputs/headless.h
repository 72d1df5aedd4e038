// An output that is only looked at over the network: there is nothing to present.
#pragma once

#include "renderer/outputs/output.h"

namespace cupola::outputs {

class HeadlessOutput final : public Output {
public:
  HeadlessOutput(int width, int height)
      : width_(width)
      , height_(height) {}

  [[nodiscard]] std::string describe() const override {
    return "headless " + std::to_string(width_) + "x" + std::to_string(height_);
  }
  void draw(const Frame&) override {}
  void present() override { ++presented_; }
  [[nodiscard]] Counters counters() const override { return {presented_, 0}; }

private:
  int width_, height_;
  std::uint64_t presented_ = 0;
};

} // namespace cupola::outputs
