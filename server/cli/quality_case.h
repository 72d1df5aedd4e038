// One subject in one projection, seen from several places: drawn with any setting and compared with what rays
// see. What `cupola bench quality` is made of. Render thread.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "configs/model/show.h"
#include "renderer/frame/renderer.h"
#include "renderer/outputs/image_file.h"
#include "renderer/reference/tracer.h"

namespace cupola::cli {

/// How a picture is drawn.
struct QualitySetting {
  model::Method method = model::Method::piecewise;
  double cubemap_scale = 0.0; ///< edge of a face over the matched one, which has the picture's density
  int supersampling = 1, samples = 1, anisotropy = 1;
  bool mipmaps = false; ///< of the cubemap
};

/// Means over the poses.
struct QualityFigures {
  double milliseconds = 0.0; ///< a frame
  double psnr_db = 0.0, ssim = 0.0, sharpness = 0.0;
};

/// A world to be looked at: its scene and the rays into it, shared by all projections and styles.
struct QualityWorld {
  std::shared_ptr<const content::Scene> scene;
  std::unique_ptr<reference::Tracer> tracer;
};

/// Parts of a picture, which stand for all of it.
struct Tiles {
  int edge = 0;             ///< pixels; 0: one tile, `window`
  int share = 1;            ///< one tile of so many is looked at, others at every pose
  reference::Rect window{}; ///< what the tiles cover; empty: the picture
};

class QualityCase {
public:
  /// Compares the tiles alone. `show`: one output, "main", with one viewport, "all"; a camera path with a
  /// pose at each whole second from 0 on, `poses` of them. Traces the reference of each. The world outlives
  /// the case. Where the show cannot be planned the problems are printed, and there are no poses.
  QualityCase(model::Show show, int poses, int reference_samples, const QualityWorld& world,
              const Tiles& tiles);

  /// Over `poses` of the poses, evenly spread. `frames`: so many of each pose after the first; the least time
  /// of these counts. False, with the problems printed, when something cannot be drawn.
  bool measure(frame::Renderer& renderer, const QualitySetting& setting, int poses, int frames,
               QualityFigures& figures);

  [[nodiscard]] int matched_size() const { return matched_; }
  [[nodiscard]] int poses() const { return static_cast<int>(references_.size()); }
  /// The tiles of a pose, one below the other, with unseen pixels (alpha 0) between.
  [[nodiscard]] const outputs::ByteImage& reference(int pose) const {
    return references_[static_cast<std::size_t>(pose)];
  }
  /// As measure() left them, one for each pose that it looked at.
  [[nodiscard]] const outputs::ByteImage& drawn(int pose) const {
    return drawn_[static_cast<std::size_t>(pose)];
  }

private:
  [[nodiscard]] std::vector<reference::Rect> tiles_of(int pose) const;

  model::Show show_;
  const QualityWorld& world_;
  Tiles tiles_;
  int matched_ = 0;
  std::vector<outputs::ByteImage> references_, drawn_;
};

/// Of the city, `triangles` of them, or the lettered room.
[[nodiscard]] QualityWorld make_world(const model::Content& content);

/// A show for a case: `poses` on a circle through the content, projections by shape.
[[nodiscard]] model::Show quality_show(const model::Content& content, const model::Style& style,
                                       const model::Shape& shape, int width, int height, int poses);

} // namespace cupola::cli
