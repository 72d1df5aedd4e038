// Show → Plan: everything about a frame that is geometry and follows from the show alone. Pure, no GL, any
// thread.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "configs/model/problem.h"
#include "configs/model/show.h"
#include "renderer/projection/map.h"

namespace cupola::plan {

/// Pixels of an output, x to the right and y downwards from the top left corner, as rows lie in files.
struct PixelRect {
  int x = 0, y = 0, width = 0, height = 0;
  bool operator==(const PixelRect&) const = default;
};

/// A part of a viewport that is drawn with one perspective projection [Lorenz & Döllner, sec. 2].
/// For a point v in view space, h = to_screen · v is homogeneous in the viewport's normalised device
/// coordinates: (x·w, y·w, w), x right, y up, [-1,1]; w > 0 in front. w is continuous over all pieces of a
/// set, so one depth convention (near / w, reversed) holds for the whole viewport.
struct Piece {
  glm::dmat3 to_screen;
  /// Inside where dot(plane, v) >= 0 for all: two for a strip (left, right), three for a triangle.
  std::array<glm::dvec3, 3> planes;
  int plane_count = 0;
  /// Of a triangle the planes are the rows of [r0 r1 r2]⁻¹: plane i · v is the barycentric coordinate of
  /// corner i, which is also the clip distance.
  PixelRect bounds; ///< pixels (of the rect given) that it may touch; strips: exactly these
};

/// A corner that triangular pieces share: the ray that it shows and where it lands. With b the barycentric
/// coordinates of a point v on the pyramid of a piece's three rays, [r0 r1 r2] b = v, the point lands at the
/// homogeneous h = Σ bᵢ wᵢ (xᵢ, yᵢ, 1). Weights belong to corners, so h is continuous over all borders.
struct Corner {
  glm::dvec3 ray;    ///< view axes, unit length
  double weight;     ///< above 0; such that a perspective stays one: −ray.z for a plain perspective
  glm::dvec2 screen; ///< normalised device coordinates of the viewport, y up; may lie outside [-1,1]²
};

/// What of a piece's pixels its projection shows.
enum class Shown : std::uint8_t {
  all,  ///< every pixel centre within the viewport
  some, ///< the rim passes through: pixels must be asked one by one (projection::ray)
};

/// A subtree of the pieces, which stand in tree order: pieces first … first + count − 1.
struct PieceGroup {
  glm::dvec3 axis;      ///< of a cone about all its rays, unit length
  double cosine = -1.0; ///< of the cone's half angle; -1: everything
  std::uint32_t first = 0, count = 0;
  std::uint32_t next =
      0; ///< the group that follows when this one is skipped: pre-order; leaves: own number + 1
};

/// All pieces of a viewport: strips in order from left to right; or one piece without planes, a perspective;
/// or triangles, whose neighbours share corners (no corner stands on another piece's border).
struct PieceSet {
  std::vector<Piece> pieces;
  bool strips = false;    ///< pieces are full-height columns: a scissor can replace the planes
  double max_error = 0.0; ///< pixels between the true projection and the pieces, sampled inside pieces
  double rms_error = 0.0;

  // Triangles only.
  std::vector<Corner> corners;
  std::vector<std::array<std::uint32_t, 3>> triangles; ///< by piece, its corners, counter-clockwise on screen
  std::vector<Shown> shown;                            ///< by piece
  std::vector<PieceGroup> groups;                      ///< a tree in pre-order, groups[0] holds all
  bool unfinished = false; ///< more pieces than max_cells would be needed: what is too coarse is looked up
  bool fills = true; ///< every pixel centre of the viewport is shown; else what is not shown stays as it was
  /// Screen triangles where no pyramid of rays is fit to draw (a pole, the rim beyond 340°, a fold): looked
  /// up in a cubemap instead. Corners in normalised device coordinates, y up.
  std::vector<std::array<glm::dvec2, 3>> looked_up;
};

/// Faces in GL order: +x −x +y −y +z −z, in view axes (the cubemap turns with the camera).
struct CubeFace {
  bool seen = false;
  PixelRect crop; ///< the part of the face that is seen, in face pixels, y downwards as GL's face t runs
};
/// By face: the directions of its s and t and of its middle, as columns, in view axes. A direction d stands
/// on the face at (s, t) = (axes[0]·d, axes[1]·d) / axes[2]·d, [-1,1] from edge to edge; texel rows follow t.
[[nodiscard]] const std::array<glm::dmat3, 6>& cube_face_axes();

struct CubemapPlan {
  int size = 0; ///< pixels along an edge
  std::array<CubeFace, 6> faces;
};

struct ViewportPlan {
  std::string name;
  PixelRect rect; ///< in output pixels, before supersampling
  projection::Map map;
  model::Method method{};
  std::optional<PieceSet>
      pieces; ///< methods piecewise and automatic (there only where it can); none: cubemap
};

/// The cubemap has to hold what this viewport shows.
[[nodiscard]] inline bool may_use_cubemap(const ViewportPlan& viewport) {
  return viewport.method == model::Method::cubemap || viewport.method == model::Method::automatic ||
         (viewport.pieces && !viewport.pieces->looked_up.empty());
}

struct OutputPlan {
  std::string name;
  int width = 0, height = 0;
  std::vector<ViewportPlan> viewports; ///< in drawing order
};

struct Plan {
  std::vector<OutputPlan> outputs;
  std::optional<CubemapPlan> cubemap; ///< one for all viewports that read it: size and faces are their union
};

struct Planned {
  Plan plan;
  model::Problems warnings;
};

/// Fails with all geometric problems of the show; their positions are left empty, pointers are filled.
/// Precondition: the show has passed the loader's checks.
[[nodiscard]] model::Result<Planned> make_plan(const model::Show& show);

/// The pieces of a projection, by whichever of the following is made for it.
[[nodiscard]] std::optional<PieceSet> make_pieces(const projection::Map& map, const PixelRect& rect,
                                                  double max_error);

/// The strips of a cylinder [Lorenz & Döllner, sec. 3.1], as few as keep within `max_error` pixels of `rect`,
/// or of one pixel's width where that is not enough (then PieceSet::max_error exceeds it); also of a
/// perspective, which is one piece. Borders stand on whole pixels; at half a turn, where zoom shows more than
/// a full turn, on the seam itself. nullopt for other shapes, an eye outside its shape, and where strips of
/// one pixel would still be too wide for a perspective. For a supersampled picture scale bounds, or pass a
/// larger `rect`.
[[nodiscard]] std::optional<PieceSet> make_strips(const projection::Map& map, const PixelRect& rect,
                                                  double max_error);

/// Triangular pieces of any projection, as few as keep within `max_error` pixels of `rect` (or as good as the
/// smallest cells get: PieceSet::max_error says). Corners stand on whole pixels; every border that is not
/// parallel to an axis keeps clear of all pixel centres (the largest powers of two dividing its dx and dy
/// differ), so that neither snapping nor rounding opens a hole. nullopt where nothing is shown, and for an
/// eye outside its shape.
[[nodiscard]] std::optional<PieceSet> make_cells(const projection::Map& map, const PixelRect& rect,
                                                 double max_error);

/// The pieces of a camera texture, which are exactly its triangles; those that cover nothing of the picture
/// are left out. max_error is 0. Where the grid folds, triangles are clockwise on screen and pieces overlap:
/// what is nearest wins there. fills is false where it is not certain. nullopt for other shapes, for an eye
/// behind the picture, and where nothing is left.
[[nodiscard]] std::optional<PieceSet> make_camera_texture_pieces(const projection::Map& map,
                                                                 const PixelRect& rect);

/// Triangles of a camera texture that are folded over, or so narrow that they cover nothing: the cell of the
/// first, counted from the top left, whether that one is narrow, and how many there are.
struct Fold {
  int column = 0, row = 0;
  bool narrow = false;
  int triangles = 0;
};
[[nodiscard]] std::optional<Fold> first_fold(const projection::Map& map);

/// Fills pieces, groups and the order of triangles from corners, triangles and shown: a tree over the
/// directions of the pieces.
void finish_triangles(PieceSet& set, const PixelRect& rect);

/// Pieces at which make_cells stops to refine.
inline constexpr std::size_t max_cells = 250'000;

inline constexpr int min_cubemap_size = 16, max_cubemap_size = 8192; ///< that "auto" may choose

/// Edge of a face whose texels match the pixels of the viewport (projection::matched_density), a multiple of
/// 8, without limits.
[[nodiscard]] int matched_cubemap_size(const projection::Map& map, const PixelRect& rect);

/// Size and seen parts of the cubemap for one viewport, with two texels around them for filtering. `size`:
/// given, or the matched one within the limits.
[[nodiscard]] CubemapPlan make_cubemap(const projection::Map& map, const PixelRect& rect,
                                       std::optional<int> size);

/// The same for parts of the viewport alone: triangles in normalised device coordinates, y up.
[[nodiscard]] CubemapPlan make_cubemap(const projection::Map& map, const PixelRect& rect,
                                       std::optional<int> size,
                                       const std::vector<std::array<glm::dvec2, 3>>& parts);

} // namespace cupola::plan
