// The rows. Name, member, unit, range, cost and text of every parameter; defaults are the structs' own.
#include <array>

#include "configs/model/describe.h"

namespace cupola::model {

template <>
struct Words<StyleKind> {
  static constexpr std::array all{"textured", "wireframe", "hatching"};
};
template <>
struct Words<Method> {
  static constexpr std::array all{"piecewise", "cubemap", "reference", "auto"};
};
template <>
struct Words<Engine> {
  static constexpr std::array all{"auto", "cpu", "gpu"};
};

namespace {

constexpr Range any_metres{-1e6, 1e6};
constexpr Range colour{0.0, 100.0};
constexpr Range full_turn{-360.0, 360.0};

const Type& orientation_type() {
  static const Type type = Describe<Orientation>("orientation", "Turned in the order yaw, pitch, roll.")
                               .number("yaw", &Orientation::yaw, Unit::degree, full_turn, Cost::uniform,
                                       "About the vertical axis, to the left.")
                               .number("pitch", &Orientation::pitch, Unit::degree, full_turn, Cost::uniform,
                                       "About the axis to the right, upwards.")
                               .number("roll", &Orientation::roll, Unit::degree, full_turn, Cost::uniform,
                                       "About the viewing direction, clockwise as the viewer sees it.")
                               .take();
  return type;
}

std::vector<Alternative> contents() {
  return {
      {"city", "A generated city: façades, roofs, streets, ground and sky.",
       Describe<City>("city", "")
           .integer("seed", &City::seed, Unit::none, {0, 4294967295.0}, Cost::rebuild,
                    "The same seed gives the same city on every machine.")
           .integer("triangles", &City::triangles, Unit::none, {500, 5'000'000}, Cost::rebuild,
                    "Size of the city: about so many triangles.")
           .share()},
      {"room", "A closed cube around the origin with coloured, lettered walls, to check axes and seams.",
       Describe<Room>("room", "")
           .number("size", &Room::size, Unit::metre, Range{0.1, 10'000.0}, Cost::rebuild, "Edge length.")
           .share()},
      {"gltf", "A glTF 2.0 file.",
       Describe<Gltf>("gltf", "")
           .text("file", &Gltf::file, Cost::rebuild, "The .gltf or .glb file, relative to the show file.",
                 true)
           .text("animation", &Gltf::animation, Cost::rebuild,
                 "Name of the animation to play; empty plays the first.")
           .number("scale", &Gltf::scale, Unit::factor, Range{1e-4, 1e4}, Cost::rebuild,
                   "Scales the whole scene.")
           .number("point_size", &Gltf::point_size, Unit::degree, Range{0.001, 45}, Cost::rebuild,
                   "Diameter of points as seen from the eye, however far they are.")
           .number("line_width", &Gltf::line_width, Unit::degree, Range{0.001, 45}, Cost::rebuild,
                   "Width of lines as seen from the eye, however far they are.")
           .share()},
  };
}

// Content is a bare variant; a holder gives it an address of its own in the document.
const Type& content_type() {
  static const Type type = [] {
    Type made;
    made.name = "content";
    made.doc = "What is shown.";
    made.alternatives = contents();
    made.kind_required = true;
    made.active = [](const void* self) { return static_cast<const Content*>(self)->index(); };
    made.held = [](const void* self) {
      return std::visit([](const auto& held) -> const void* { return &held; },
                        *static_cast<const Content*>(self));
    };
    made.activate = [](void* self, std::size_t index) -> void* {
      auto& target = *static_cast<Content*>(self);
      if (index == 0) return &target.emplace<City>();
      if (index == 1) return &target.emplace<Room>();
      return &target.emplace<Gltf>();
    };
    return made;
  }();
  return type;
}

const Type& sun_type() {
  static const Type type =
      Describe<Sun>("sun", "The directional light.")
          .number("azimuth", &Sun::azimuth, Unit::degree, full_turn, Cost::uniform,
                  "Compass direction of the sun: 0 ahead (-z), 90 right (+x).")
          .number("elevation", &Sun::elevation, Unit::degree, Range{-90, 90}, Cost::uniform,
                  "Height above the horizon.")
          .vector3("color", &Sun::color, Unit::none, colour, Cost::uniform, "Linear colour.")
          .number("intensity", &Sun::intensity, Unit::factor, Range{0, 1000}, Cost::uniform,
                  "Factor on the colour.")
          .take();
  return type;
}

const Type& sky_type() {
  static const Type type = Describe<Sky>("sky", "Ambient light from above and below.")
                               .vector3("zenith", &Sky::zenith, Unit::none, colour, Cost::uniform,
                                        "Linear colour of light from above.")
                               .vector3("ground", &Sky::ground, Unit::none, colour, Cost::uniform,
                                        "Linear colour of light from below.")
                               .number("intensity", &Sky::intensity, Unit::factor, Range{0, 1000},
                                       Cost::uniform, "Factor on both colours.")
                               .take();
  return type;
}

const Type& fog_type() {
  static const Type type =
      Describe<Fog>("fog", "Colour mixed in by distance.")
          .number("density", &Fog::density, Unit::per_metre, Range{0, 10}, Cost::uniform,
                  "Share mixed in at a distance d: 1 - exp(-density * d).")
          .vector3("color", &Fog::color, Unit::none, colour, Cost::uniform, "Linear colour.")
          .take();
  return type;
}

const Type& style_type() {
  static const Type type =
      Describe<Style>("style", "How surfaces are drawn.")
          .choice("kind", &Style::kind, Cost::uniform, "textured, solid wireframe, or pen-and-ink hatching.")
          .number("line_width", &Style::line_width, Unit::pixel, Range{0.1, 64}, Cost::uniform,
                  "Width of wireframe lines and hatching strokes.")
          .number("line_spacing", &Style::line_spacing, Unit::pixel, Range{2, 256}, Cost::uniform,
                  "Distance between hatching strokes.")
          .number("line_fade", &Style::line_fade, Unit::metre, Range{0.1, 1e6}, Cost::uniform,
                  "Distance at which wireframe lines are half as strong.")
          .take();
  return type;
}

const Type& scene_type() {
  static const Type type = Describe<Scene>("scene", "What is rendered and how it is lit.")
                               .object("content", &Scene::content, content_type(), "What is shown.")
                               .object("sun", &Scene::sun, sun_type(), "The directional light.")
                               .object("sky", &Scene::sky, sky_type(), "Ambient light.")
                               .object("fog", &Scene::fog, fog_type(), "Fog by distance.")
                               .object("style", &Scene::style, style_type(), "How surfaces are drawn.")
                               .take();
  return type;
}

const Type& keyframe_type() {
  static const Type type =
      Describe<Keyframe>("keyframe", "Where the camera is at a time.")
          .number("time", &Keyframe::time, Unit::second, Range{0, 1e6}, Cost::uniform,
                  "Seconds from the start of the path.")
          .vector3("position", &Keyframe::position, Unit::metre, any_metres, Cost::uniform,
                   "Place of the camera.")
          .object("orientation", &Keyframe::orientation, orientation_type(), "Where it looks, by angles.")
          .vector3("look_to", &Keyframe::look_to, Unit::none, any_metres, Cost::uniform,
                   "Where it looks, as a direction; instead of orientation.")
          .take();
  return type;
}

const Type& camera_type() {
  static const Type type =
      Describe<Camera>("camera", "The single centre of all projections.")
          .vector3("position", &Camera::position, Unit::metre, any_metres, Cost::uniform,
                   "Place of the camera.")
          .object("orientation", &Camera::orientation, orientation_type(), "Where it looks, by angles.")
          .vector3("look_to", &Camera::look_to, Unit::none, any_metres, Cost::uniform,
                   "Where it looks, as a direction; instead of orientation.")
          .vector3("up", &Camera::up, Unit::none, any_metres, Cost::uniform,
                   "Upwards in the picture, with look_to.")
          .list("path", &Camera::path, keyframe_type(), {0, 10'000}, Cost::uniform,
                "Key frames with rising times. While there are any, the camera follows them.")
          .boolean("loop", &Camera::loop, Cost::uniform, "The path starts again after its last key frame.")
          .number("near", &Camera::near, Unit::metre, Range{1e-4, 1e4}, Cost::uniform,
                  "Nothing nearer is drawn.")
          .take();
  return type;
}

const Type& deformation_type() {
  static const Type type =
      Describe<Deformation>("deformation", "A generated deformation of a camera texture.")
          .variant(
              &Deformation::bend, true, Cost::rebuild,
              {{"zoom", "Moves along the radius, most in the centre: a bulge of the whole picture.",
                Describe<RadialZoom>("zoom", "")
                    .number("strength", &RadialZoom::strength, Unit::none, Range{-0.95, 10}, Cost::rebuild,
                            "The centre is magnified 1 + strength times; the picture folds above 2.24.")
                    .share()},
               {"swirl", "Turns about the centre, less and less outwards.",
                Describe<Swirl>("swirl", "")
                    .number("angle", &Swirl::angle, Unit::degree, Range{-3600, 3600}, Cost::rebuild,
                            "Of the centre, counter-clockwise.")
                    .share()},
               {"lens", "A magnifier: bends what is within the radius, and nothing outside.",
                Describe<Lens>("lens", "")
                    .number("strength", &Lens::strength, Unit::none, Range{-0.95, 10}, Cost::rebuild,
                            "The centre is magnified 1 + strength times; the picture folds above 1.4.")
                    .share()},
               {"ripple", "Rings of waves about the centre.",
                Describe<Ripple>("ripple", "")
                    .number("amplitude", &Ripple::amplitude, Unit::none, Range{-1, 1}, Cost::rebuild,
                            "In halves of the shorter side; the picture folds above wavelength / 2π.")
                    .number("wavelength", &Ripple::wavelength, Unit::none, Range{0.01, 100}, Cost::rebuild,
                            "In halves of the shorter side.")
                    .share()}})
          .number("center_s", &Deformation::center_s, Unit::none, Range{-2, 2}, Cost::rebuild,
                  "Its centre in the picture: -1 left, 1 right.")
          .number("center_t", &Deformation::center_t, Unit::none, Range{-2, 2}, Cost::rebuild,
                  "Its centre in the picture: -1 bottom, 1 top.")
          .number("radius", &Deformation::radius, Unit::none, Range{0.01, 100}, Cost::rebuild,
                  "In halves of the shorter side: where a lens ends, and the others are down to 37 %.")
          .integer("order", &Deformation::order, Unit::none, {-1000, 1000}, Cost::rebuild,
                   "Deformations act in rising order.")
          .take();
  return type;
}

std::shared_ptr<const Type> camera_texture_type() {
  return Describe<CameraTexture>("camera_texture", "")
      .number("horizontal_fov", &CameraTexture::horizontal_fov, Unit::degree, Range{0.1, 175}, Cost::rebuild,
              "Field of view across, of the perspective that is bent.")
      .number("vertical_fov", &CameraTexture::vertical_fov, Unit::degree, Range{0.1, 175}, Cost::rebuild,
              "Field of view from bottom to top; absent: pixels are square.")
      .integer("columns", &CameraTexture::columns, Unit::none, {1, 512}, Cost::rebuild,
               "Cells of the grid across.")
      .integer("rows", &CameraTexture::rows, Unit::none, {1, 512}, Cost::rebuild,
               "Cells of the grid from top to bottom.")
      .grid("offsets", &CameraTexture::offsets, Unit::none, {-4, 4}, Cost::rebuild,
            "How far each vertex lands from where it stands, [right, up], the picture being 2 wide and high: "
            "from the top, rows + 1 arrays of columns + 1 pairs.")
      .map("deformations", &CameraTexture::deformations, deformation_type(), {0, 64}, Cost::rebuild,
           "Generated deformations by name, after the offsets.")
      .share();
}

const Type& projection_type() {
  static const Type type =
      Describe<Projection>("projection", "A single-centre map from image coordinates to directions.")
          .variant(
              &Projection::shape, true, Cost::rebuild,
              {{"perspective", "A flat picture.",
                Describe<Perspective>("perspective", "")
                    .number("horizontal_fov", &Perspective::horizontal_fov, Unit::degree, Range{0.1, 175},
                            Cost::rebuild, "Field of view across.")
                    .number("vertical_fov", &Perspective::vertical_fov, Unit::degree, Range{0.1, 175},
                            Cost::rebuild, "Field of view from bottom to top; absent: pixels are square.")
                    .share()},
               {"cylinder", "Equal angles across, perspective along the axis: for cylinder walls.",
                Describe<Cylinder>("cylinder", "")
                    .number("horizontal_fov", &Cylinder::horizontal_fov, Unit::degree, Range{1, 360},
                            Cost::rebuild, "Field of view across.")
                    .number("vertical_fov", &Cylinder::vertical_fov, Unit::degree, Range{0.1, 170},
                            Cost::rebuild, "Field of view from bottom to top.")
                    .share()},
               {"fisheye", "Equidistant fisheye, its circle inscribed in the shorter side: for domes.",
                Describe<Fisheye>("fisheye", "")
                    .number("fov", &Fisheye::fov, Unit::degree, Range{1, 360}, Cost::rebuild,
                            "Field of view across the circle.")
                    .share()},
               {"equirectangular", "Longitude across, latitude upwards.",
                Describe<Equirectangular>("equirectangular", "")
                    .number("horizontal_fov", &Equirectangular::horizontal_fov, Unit::degree, Range{1, 360},
                            Cost::rebuild, "Longitudes shown.")
                    .number("vertical_fov", &Equirectangular::vertical_fov, Unit::degree, Range{1, 180},
                            Cost::rebuild, "Latitudes shown.")
                    .share()},
               {"stereographic",
                "Stereographic fisheye, its circle inscribed in the shorter side: what is small keeps its "
                "form.",
                Describe<Stereographic>("stereographic", "")
                    .number("fov", &Stereographic::fov, Unit::degree, Range{1, 350}, Cost::rebuild,
                            "Field of view across the circle.")
                    .share()},
               {"orthographic",
                "Orthographic fisheye, its circle inscribed in the shorter side: a hemisphere as seen from "
                "infinitely far.",
                Describe<Orthographic>("orthographic", "")
                    .number("fov", &Orthographic::fov, Unit::degree, Range{1, 180}, Cost::rebuild,
                            "Field of view across the circle.")
                    .share()},
               {"mercator", "Longitude across, latitudes stretched so that what is small keeps its form.",
                Describe<Mercator>("mercator", "")
                    .number("horizontal_fov", &Mercator::horizontal_fov, Unit::degree, Range{1, 360},
                            Cost::rebuild, "Longitudes shown.")
                    .number("vertical_fov", &Mercator::vertical_fov, Unit::degree, Range{1, 178},
                            Cost::rebuild, "Latitudes shown.")
                    .share()},
               {"panini", "A wide picture with straight verticals.",
                Describe<Panini>("panini", "")
                    .number("horizontal_fov", &Panini::horizontal_fov, Unit::degree, Range{0.1, 350},
                            Cost::rebuild,
                            "Field of view across. Distances far from 1 allow less: 0 and endless ones less "
                            "than 180.")
                    .number("vertical_fov", &Panini::vertical_fov, Unit::degree, Range{0.1, 175},
                            Cost::rebuild,
                            "Field of view along the middle column; absent: pixels are square in the middle.")
                    .number("distance", &Panini::distance, Unit::factor, Range{0, 100}, Cost::rebuild,
                            "From how many radii behind the eye its wall is drawn: 0 is a perspective, 1 the "
                            "usual picture.")
                    .share()},
               {"cube_cross",
                "The six faces of a cube as a horizontal cross: left, front, right, back, with top and "
                "bottom "
                "at the front; nothing is shown beside them.",
                Describe<CubeCross>("cube_cross", "").share()},
               {"camera_texture",
                "A perspective whose picture is bent by a grid of offsets, given or generated.",
                camera_texture_type()}})
          .number("zoom", &Projection::zoom, Unit::factor, Range{0.05, 100}, Cost::rebuild,
                  "Magnification about the image centre: 2 shows half the field.")
          .vector3("off_axis", &Projection::off_axis, Unit::factor, Range{-0.95, 0.95}, Cost::rebuild,
                   "Off-axis vector, in radii of the shape: moves the eye away from its centre.")
          .object("orientation", &Projection::orientation, orientation_type(),
                  "Of the image centre against the camera.")
          .take();
  return type;
}

const Type& viewport_type() {
  static const Type type = Describe<Viewport>("viewport", "A rectangle of an output with one projection.")
                               .text("projection", &Viewport::projection, Cost::rebuild,
                                     "Name of one of the show's projections.", true)
                               .choice("method", &Viewport::method, Cost::rebuild,
                                       "piecewise: rasterised straight into perspective pieces. cubemap: six "
                                       "faces, then a lookup per pixel. "
                                       "reference: rays on the CPU, slow and right. "
                                       "auto: tries piecewise and cubemap, and stays with the quicker one.")
                               .number("x", &Viewport::x, Unit::fraction, Range{0, 1}, Cost::rebuild,
                                       "Left edge, as a fraction of the output.")
                               .number("y", &Viewport::y, Unit::fraction, Range{0, 1}, Cost::rebuild,
                                       "Top edge, as a fraction of the output.")
                               .number("width", &Viewport::width, Unit::fraction, Range{0, 1, true},
                                       Cost::rebuild, "Fraction of the output.")
                               .number("height", &Viewport::height, Unit::fraction, Range{0, 1, true},
                                       Cost::rebuild, "Fraction of the output.")
                               .integer("order", &Viewport::order, Unit::none, {-1000, 1000}, Cost::rebuild,
                                        "Overlapping viewports are drawn in rising order.")
                               .take();
  return type;
}

const Type& output_type() {
  static const Type type =
      Describe<Output>("output", "A rectangle of pixels that reaches a window, a file or a memory buffer.")
          .variant(
              &Output::sink, false, Cost::reopen,
              {{"auto", "A window where there is a display, otherwise headless.",
                Describe<AutoOutput>("auto", "").share()},
               {"headless", "A picture in memory, seen over the network.",
                Describe<HeadlessOutput>("headless", "").share()},
               {"window", "A window on a monitor.",
                Describe<WindowOutput>("window", "")
                    .text("monitor", &WindowOutput::monitor, Cost::reopen,
                          "Name or index (from 0) of the monitor; empty: the primary one.")
                    .boolean("fullscreen", &WindowOutput::fullscreen, Cost::reopen, "Covers the monitor.")
                    .boolean("vsync", &WindowOutput::vsync, Cost::reopen,
                             "Presents with the monitor's refresh.")
                    .boolean("decorated", &WindowOutput::decorated, Cost::reopen, "Has a title bar.")
                    .integer("x", &WindowOutput::x, Unit::pixel, {-65536, 65536}, Cost::reopen,
                             "Left edge on the monitor.")
                    .integer("y", &WindowOutput::y, Unit::pixel, {-65536, 65536}, Cost::reopen,
                             "Top edge on the monitor.")
                    .share()},
               {"files", "Every frame as a numbered picture.",
                Describe<FilesOutput>("files", "")
                    .text("directory", &FilesOutput::directory, Cost::reopen, "Folder, made when missing.")
                    .word("format", &FilesOutput::format, {"png", "jpg", "exr", "tif"}, Cost::reopen,
                          "Kind of picture.")
                    .integer("limit", &FilesOutput::limit, Unit::none, {0, 1e9}, Cost::reopen,
                             "Stops writing after so many pictures; 0 never stops.")
                    .share()}})
          .integer("width", &Output::width, Unit::pixel, {1, 16384}, Cost::reopen, "Pixels across.")
          .integer("height", &Output::height, Unit::pixel, {1, 16384}, Cost::reopen,
                   "Pixels from top to bottom.")
          .map("viewports", &Output::viewports, viewport_type(), {1, 256}, Cost::rebuild,
               "What the output shows, by name.")
          .take();
  return type;
}

const Type& quality_type() {
  static const Type type =
      Describe<Quality>("quality", "How carefully is rendered.")
          .boolean("automatic", &Quality::automatic, Cost::rebuild,
                   "Chooses samples, supersampling and anisotropy by the time that frames take: the best "
                   "that hold "
                   "frame_rate, or off-line the best there are. What is given for them does not count "
                   "meanwhile, as "
                   "limits neither.")
          .integer(
              "samples", &Quality::samples, Unit::none, {1, 64}, Cost::rebuild,
              "Samples a pixel: multisampling, clamped to what the driver has; rays of the reference, with "
              "automatic too.")
          .integer("supersampling", &Quality::supersampling, Unit::factor, {1, 8}, Cost::rebuild,
                   "Pictures are drawn so many times as wide and high, then averaged.")
          .integer("anisotropy", &Quality::anisotropy, Unit::factor, {1, 16}, Cost::rebuild,
                   "Of texture filtering, clamped to what the driver has.")
          .integer("cubemap_size", &Quality::cubemap_size, Unit::pixel, {16, 16384}, Cost::rebuild,
                   "Edge of a cubemap face, or \"auto\": as dense as the densest pixel of the projection.")
          .boolean("cubemap_single_pass", &Quality::cubemap_single_pass, Cost::rebuild,
                   "All faces in one layered pass instead of one pass per face.")
          .boolean("cubemap_mipmaps", &Quality::cubemap_mipmaps, Cost::rebuild,
                   "Mipmaps the cubemap for strong minification.")
          .take();
  return type;
}

const Type& pieces_type() {
  static const Type type =
      Describe<Pieces>("pieces", "Piecewise perspective projection.")
          .number("max_error", &Pieces::max_error, Unit::pixel, Range{0.01, 64}, Cost::rebuild,
                  "Largest distance between the true projection and its pieces.")
          .choice("engine", &Pieces::engine, Cost::rebuild,
                  "Which processor distributes primitives to pieces; auto chooses by the device.")
          .integer("max_replicated", &Pieces::max_replicated, Unit::none, {1000, 1e9}, Cost::rebuild,
                   "Ceiling on replicated triangles in memory; what is more is drawn in several goes, none "
                   "is left out.")
          .take();
  return type;
}

const Type& debug_type() {
  static const Type type =
      Describe<Debug>("debug", "What is drawn over pictures to show how they come about.")
          .boolean("pieces", &Debug::pieces, Cost::uniform,
                   "Black borders of pieces over viewports that are drawn piecewise.")
          .boolean("primitives", &Debug::primitives, Cost::uniform,
                   "Thick white edges of the scene's triangles, by every method but the reference.")
          .take();
  return type;
}

template <class L>
Type listener_type(const char* name, const char* doc) {
  return Describe<L>(name, doc)
      .boolean("enabled", &L::enabled, Cost::restart, "Listens at all.")
      .text("address", &L::address, Cost::restart, "Address of this machine to listen on.")
      .integer("port", &L::port, Unit::none, {0, 65535}, Cost::restart, "Port; 0 lets the system choose.")
      .take();
}

const Type& control_type() {
  static const Type http =
      listener_type<HttpListener>("http", "Status, show, changes and live pictures for browsers and tools.");
  static const Type osc = listener_type<OscListener>("osc", "Open Sound Control over UDP.");
  static const Type type = Describe<Control>("control", "Listeners for live control.")
                               .object("http", &Control::http, http, "HTTP.")
                               .object("osc", &Control::osc, osc, "OSC.")
                               .take();
  return type;
}

} // namespace

const Type& show_type() {
  static const Type type =
      Describe<Show>("show", "Everything a show is.")
          .integer("version", &Show::version, Unit::none, {1, 1}, Cost::restart,
                   "Version of the show format.")
          .text("name", &Show::name, Cost::uniform, "Title of the show.")
          .number("frame_rate", &Show::frame_rate, Unit::hertz, Range{1, 480}, Cost::uniform,
                  "Frames a second to aim for.")
          .vector3("background", &Show::background, Unit::none, colour, Cost::uniform,
                   "Linear colour where nothing is drawn.")
          .object("scene", &Show::scene, scene_type(), "What is rendered and how it is lit.")
          .object("camera", &Show::camera, camera_type(), "The single centre of all projections.")
          .map("projections", &Show::projections, projection_type(), {0, 256}, Cost::rebuild,
               "Projections by name.")
          .map("outputs", &Show::outputs, output_type(), {1, 64}, Cost::reopen, "Outputs by name.")
          .object("quality", &Show::quality, quality_type(), "How carefully is rendered.")
          .object("pieces", &Show::pieces, pieces_type(), "Piecewise perspective projection.")
          .object("debug", &Show::debug, debug_type(),
                  "What is drawn over pictures to show how they come about.")
          .object("control", &Show::control, control_type(), "Listeners for live control.")
          .take();
  // `version` has no default worth guessing: a show says which format it is written in.
  static const Type with_version = [] {
    Type made = type;
    made.rows.front().required = true;
    return made;
  }();
  return with_version;
}

} // namespace cupola::model
