// Show: everything a show is, as plain values. No behaviour, no GL, no pointers. Defaults stand here and
// nowhere else; names, units, ranges and texts stand in parameters.cpp.
// Axes: right-handed, x right, y up, -z ahead. Lengths in metres, times in seconds.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace cupola::model {

/// An angle as the file has it, so that writing it back gives the same digits; maths asks for radians.
struct Angle {
  double degrees = 0.0;
  [[nodiscard]] constexpr double radians() const { return degrees * std::numbers::pi / 180.0; }
  bool operator==(const Angle&) const = default;
};

/// Turned in the order yaw (about +y, left positive), pitch (about +x, up positive), roll (about -z,
/// clockwise positive as seen by the viewer).
struct Orientation {
  Angle yaw, pitch, roll;
  bool operator==(const Orientation&) const = default;
};

// ---- scene ----------------------------------------------------------------------------------------

/// A generated city, the same on every machine for the same seed.
struct City {
  std::uint32_t seed = 1;
  int triangles = 35'000; ///< about; the generator comes within 2 %
  bool operator==(const City&) const = default;
};

/// A closed cube around the origin whose walls are coloured and lettered by axis (+X, -X, …).
struct Room {
  double size = 10.0; ///< edge length in metres
  bool operator==(const Room&) const = default;
};

/// A glTF 2.0 file (.gltf or .glb).
struct Gltf {
  std::string file;      ///< relative to the show file
  std::string animation; ///< name of the animation to play; "" plays the first, if any
  double scale = 1.0;
  Angle point_size{0.1}; ///< diameter of points as seen from the eye
  Angle line_width{0.1}; ///< of lines as seen from the eye
  bool operator==(const Gltf&) const = default;
};

using Content = std::variant<City, Room, Gltf>;

struct Sun {
  Angle azimuth{135.0};  ///< compass: 0 is -z (ahead), 90 is +x (right)
  Angle elevation{40.0}; ///< above the horizon
  glm::dvec3 color{1.0, 0.95, 0.86};
  double intensity = 2.4;
  bool operator==(const Sun&) const = default;
};

/// Ambient light: blends from `ground` (normals down) to `zenith` (normals up).
struct Sky {
  glm::dvec3 zenith{0.42, 0.55, 0.80};
  glm::dvec3 ground{0.22, 0.20, 0.18};
  double intensity = 0.9;
  bool operator==(const Sky&) const = default;
};

/// Colour mixed in by distance: 1 - exp(-density * metres).
struct Fog {
  double density = 0.0;
  glm::dvec3 color{0.62, 0.70, 0.80};
  bool operator==(const Fog&) const = default;
};

enum class StyleKind : std::uint8_t { textured, wireframe, hatching };

/// How surfaces are drawn; widths are in output pixels for every method.
struct Style {
  StyleKind kind = StyleKind::textured;
  double line_width = 1.2;   ///< pixels: edges of `wireframe`, strokes of `hatching`
  double line_spacing = 7.0; ///< pixels between the strokes of `hatching`
  double line_fade = 150.0;  ///< metres at which the edges of `wireframe` are half as strong
  bool operator==(const Style&) const = default;
};

struct Scene {
  Content content;
  Sun sun;
  Sky sky;
  Fog fog;
  Style style;
  bool operator==(const Scene&) const = default;
};

// ---- camera ---------------------------------------------------------------------------------------

struct Keyframe {
  double time = 0.0;
  glm::dvec3 position{0.0};
  Orientation orientation;
  std::optional<glm::dvec3> look_to; ///< direction; instead of orientation
  bool operator==(const Keyframe&) const = default;
};

struct Camera {
  glm::dvec3 position{0.0, 1.7, 0.0};
  Orientation orientation;
  std::optional<glm::dvec3> look_to; ///< direction; instead of orientation
  glm::dvec3 up{0.0, 1.0, 0.0};      ///< with look_to
  std::vector<Keyframe> path;        ///< if not empty: followed in time, position and orientation are ignored
  bool loop = true;                  ///< path starts again after its last key frame
  double near = 0.05;                ///< nothing nearer than this is drawn, metres
  bool operator==(const Camera&) const = default;
};

// ---- projections ----------------------------------------------------------------------------------

/// A flat picture. vertical_fov absent: follows from the viewport so that pixels are square.
struct Perspective {
  Angle horizontal_fov{75.0};
  std::optional<Angle> vertical_fov;
  bool operator==(const Perspective&) const = default;
};

/// Horizontal cylinder: equal angles across, perspective along the axis.
struct Cylinder {
  Angle horizontal_fov{180.0};
  Angle vertical_fov{60.0};
  bool operator==(const Cylinder&) const = default;
};

/// Equidistant fisheye; its circle is inscribed in the shorter side of the viewport, black outside.
struct Fisheye {
  Angle fov{180.0};
  bool operator==(const Fisheye&) const = default;
};

/// Longitude across, latitude along t.
struct Equirectangular {
  Angle horizontal_fov{360.0};
  Angle vertical_fov{180.0};
  bool operator==(const Equirectangular&) const = default;
};

/// Stereographic fisheye: what is small keeps its form; circle as a fisheye's.
struct Stereographic {
  Angle fov{180.0};
  bool operator==(const Stereographic&) const = default;
};

/// Orthographic fisheye: a hemisphere as seen from infinitely far; circle as a fisheye's.
struct Orthographic {
  Angle fov{180.0};
  bool operator==(const Orthographic&) const = default;
};

/// Longitude across, latitudes stretched so that what is small keeps its form.
struct Mercator {
  Angle horizontal_fov{360.0};
  Angle vertical_fov{150.0};
  bool operator==(const Mercator&) const = default;
};

/// A wide picture with straight verticals, seen from `distance` radii behind the eye: 0 is a perspective.
/// vertical_fov, along the middle column, absent: pixels are square in the middle.
struct Panini {
  Angle horizontal_fov{150.0};
  std::optional<Angle> vertical_fov;
  double distance = 1.0;
  bool operator==(const Panini&) const = default;
};

/// The six faces of a cube as a horizontal cross.
struct CubeCross {
  bool operator==(const CubeCross&) const = default;
};

/// Moves along the radius, most in the centre: a bulge (above 0) or a dent (below) of the whole picture.
struct RadialZoom {
  double strength = 0.5; ///< the centre is magnified 1 + strength times
  bool operator==(const RadialZoom&) const = default;
};

/// Turns about the centre, less and less outwards.
struct Swirl {
  Angle angle{45.0}; ///< in the centre, counter-clockwise
  bool operator==(const Swirl&) const = default;
};

/// A magnifier: what is within the radius, and nothing outside.
struct Lens {
  double strength = 0.5; ///< the centre is magnified 1 + strength times
  bool operator==(const Lens&) const = default;
};

/// Rings of waves about the centre.
struct Ripple {
  double amplitude = 0.02, wavelength = 0.4; ///< in halves of the shorter side
  bool operator==(const Ripple&) const = default;
};

/// A generated deformation of a camera texture; see renderer/projection/deformation.h.
struct Deformation {
  std::variant<RadialZoom, Swirl, Lens, Ripple> bend;
  double center_s = 0.0, center_t = 0.0; ///< image coordinates
  double radius = 0.7;                   ///< in halves of the shorter side
  int order = 0;                         ///< they act in rising order
  bool operator==(const Deformation&) const = default;
};

/// A perspective whose picture is bent by a grid: its vertices land beside where they stand.
struct CameraTexture {
  Angle horizontal_fov{75.0};
  std::optional<Angle> vertical_fov; ///< absent: follows from the viewport so that pixels are square
  int columns = 64, rows = 48;       ///< cells of the grid
  /// By row from the top, rows + 1 of columns + 1: how far a vertex lands from where it stands, in image
  /// coordinates (s right, t up, the picture from -1 to 1). Empty: nowhere else.
  std::vector<std::vector<glm::dvec2>> offsets;
  std::map<std::string, Deformation> deformations; ///< after the offsets
  bool operator==(const CameraTexture&) const = default;
};

using Shape = std::variant<Perspective, Cylinder, Fisheye, Equirectangular, Stereographic, Orthographic,
                           Mercator, Panini, CubeCross, CameraTexture>;

struct Projection {
  Shape shape;
  double zoom = 1.0; ///< magnification about the image centre: 2 shows half the field
  glm::dvec3 off_axis{
      0.0}; ///< O of the sampling vector [Trapp & Döllner, sec. 3], in radii of the unit shape
  Orientation orientation; ///< of the projection's centre against the camera
  bool operator==(const Projection&) const = default;
};

// ---- outputs --------------------------------------------------------------------------------------

enum class Method : std::uint8_t { piecewise, cubemap, reference, automatic };

/// A rectangle of an output. x, y, width, height are fractions of the output; (0,0) is its top left corner.
struct Viewport {
  std::string projection; ///< name in Show::projections
  Method method = Method::cubemap;
  double x = 0.0, y = 0.0, width = 1.0, height = 1.0;
  int order = 0; ///< overlapping viewports are drawn in rising order
  bool operator==(const Viewport&) const = default;
};

/// A window where there is a display, else headless.
struct AutoOutput {
  bool operator==(const AutoOutput&) const = default;
};

/// A picture in memory, seen over the network.
struct HeadlessOutput {
  bool operator==(const HeadlessOutput&) const = default;
};

struct WindowOutput {
  std::string monitor;     ///< name, or index from 0 as text; "" is the primary one
  bool fullscreen = false; ///< covers the monitor; width and height are then the size rendered
  bool vsync = true;
  bool decorated = true;
  int x = 0, y = 0; ///< of a window that is not full-screen, in pixels from the monitor's top left corner
  bool operator==(const WindowOutput&) const = default;
};

/// Every frame as a numbered picture.
struct FilesOutput {
  std::string directory = "frames"; ///< relative to the working folder
  std::string format = "png";       ///< png, jpg, exr or tif
  int limit = 0;                    ///< stop writing after so many pictures; 0: never
  bool operator==(const FilesOutput&) const = default;
};

using Sink = std::variant<AutoOutput, HeadlessOutput, WindowOutput, FilesOutput>;

struct Output {
  Sink sink;
  int width = 1280, height = 720; ///< pixels rendered
  std::map<std::string, Viewport> viewports;
  bool operator==(const Output&) const = default;
};

// ---- quality, control -----------------------------------------------------------------------------

struct Quality {
  bool automatic = false;           ///< samples, supersampling and anisotropy are chosen by frame time
  int samples = 1;                  ///< multisampling; clamped to what the driver has
  int supersampling = 1;            ///< k: every viewport is drawn k times as wide and high, then averaged
  int anisotropy = 1;               ///< of texture filtering; clamped to what the driver has
  std::optional<int> cubemap_size;  ///< edge of a face in pixels; absent ("auto"): matches the densest pixel
  bool cubemap_single_pass = false; ///< all faces in one layered pass instead of one pass per face
  bool cubemap_mipmaps = false;     ///< for strong minification in the lookup
  bool operator==(const Quality&) const = default;
};

enum class Engine : std::uint8_t { automatic, cpu, gpu };

struct Pieces {
  double max_error = 0.25; ///< pixels between the true projection and its pieces
  Engine engine = Engine::automatic;
  int max_replicated = 64'000'000; ///< ceiling on replicated triangles in a frame
  bool operator==(const Pieces&) const = default;
};

/// Drawn over pictures so that one sees how they come about.
struct Debug {
  bool pieces = false;     ///< borders of pieces, black, over viewports that are drawn piecewise
  bool primitives = false; ///< edges of the scene's triangles, white
  bool operator==(const Debug&) const = default;
};

struct HttpListener {
  bool enabled = true;
  std::string address = "127.0.0.1";
  int port = 8750;
  bool operator==(const HttpListener&) const = default;
};

struct OscListener {
  bool enabled = true;
  std::string address = "127.0.0.1";
  int port = 8751;
  bool operator==(const OscListener&) const = default;
};

struct Control {
  HttpListener http;
  OscListener osc;
  bool operator==(const Control&) const = default;
};

struct Show {
  int version = 1;
  std::string name;
  double frame_rate = 60.0;
  glm::dvec3 background{0.0}; ///< linear colour where nothing is drawn
  Scene scene;
  Camera camera;
  std::map<std::string, Projection> projections;
  std::map<std::string, Output> outputs;
  Quality quality;
  Pieces pieces;
  Debug debug;
  Control control;
  bool operator==(const Show&) const = default;
};

} // namespace cupola::model
