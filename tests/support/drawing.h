// Drawing in tests: a headless context, a show, a picture.
#pragma once

#include <memory>
#include <string>

#include "configs/model/show.h"
#include "renderer/content/scene.h"
#include "server/cli/offline.h"
#include "tests/support/image.h"

namespace cupola::tests {

/// One headless renderer for a test program; fails the test where there is none.
[[nodiscard]] cli::OfflineRenderer& renderer();

/// A show with one output "main" of one viewport "all" that shows `projection` with `method`.
[[nodiscard]] model::Show make_show(model::Content content, const model::Projection& projection,
                                    model::Method method, int width, int height);

/// The first picture of the show at `time`. Keeps the scene of the last call when the content is the same.
[[nodiscard]] Shot draw(const model::Show& show, double time = 0.0);

/// The statistics of the last draw().
[[nodiscard]] const frame::FrameStatistics& last_statistics();

/// Pixels of exactly this colour.
[[nodiscard]] long count_pixels(const Shot& shot, int red, int green, int blue);

/// Peak signal to noise ratio over RGB in decibels.
[[nodiscard]] double psnr(const Shot& a, const Shot& b);

} // namespace cupola::tests
