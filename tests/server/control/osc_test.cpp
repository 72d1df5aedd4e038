#include <cmath>
#include <doctest/doctest.h>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>

#include "server/control/osc/packet.h"
#include "server/control/osc/values.h"
#include "tests/server/small_show.h"

using namespace cupola;
using namespace cupola::control;
using model::Code;
using model::Json;

namespace {

OscArgument real(double value, char type = 'f') { return {type, value, 0, {}}; }
OscArgument whole(std::int64_t value) { return {'i', static_cast<double>(value), value, {}}; }
OscArgument word(std::string value) { return {'s', 0.0, 0, std::move(value)}; }

std::string bundle(const std::vector<std::string>& elements) {
  std::string out("#bundle\0\0\0\0\0\0\0\0\1", 16);
  for (const std::string& element : elements) {
    for (int shift = 24; shift >= 0; shift -= 8) out += static_cast<char>(element.size() >> shift & 255);
    out += element;
  }
  return out;
}

} // namespace

TEST_CASE("a message survives the wire") {
  const OscMessage sent{"/a/b",
                        {whole(-7), real(0.1), real(1.0 / 3.0, 'd'), word("dome"), {'T'}, {'F'}, {'N'}}};
  const auto got = parse_packet(to_packet(sent));
  REQUIRE(got);
  REQUIRE(got->size() == 1);
  const OscMessage& message = got->front();
  CHECK(message.address == "/a/b");
  REQUIRE(message.arguments.size() == 7);
  CHECK(message.arguments[0].integer == -7);
  CHECK(message.arguments[1].number == 0.1); // not 0.100000001490116
  CHECK(message.arguments[2].number == 1.0 / 3.0);
  CHECK(message.arguments[3].text == "dome");
  CHECK(message.arguments[4].type == 'T');
  CHECK(message.arguments[6].type == 'N');
}

TEST_CASE("bundles, nested too, give their messages in order") {
  const std::string a = to_packet({"/a", {whole(1)}}), b = to_packet({"/b", {}}),
                    c = to_packet({"/c", {word("x")}});
  const auto got = parse_packet(bundle({a, bundle({b, bundle({})}), c}));
  REQUIRE(got);
  REQUIRE(got->size() == 3);
  CHECK((*got)[1].address == "/b");
  CHECK((*got)[2].address == "/c");
}

TEST_CASE("what is not OSC is refused") {
  std::string deep = to_packet({"/a", {}});
  for (int i = 0; i < 9; ++i) deep = bundle({deep});
  const std::string good = to_packet({"/abc", {real(1.0), word("text")}});
  std::vector<std::string> bad{"",
                               "x",
                               "/abc",
                               std::string("/abc\0\0\0\0", 8),              // no type tag
                               std::string("/abc\0\0\0\0,fff\0\0\0\0", 16), // arguments missing
                               std::string("/abc\0\0\0\0,s\0\0abcd", 16),   // a text without an end
                               std::string("/abc\0\0\0\0,b\0\0\x7f\xff\xff\xff", 16),
                               std::string("/abc\0\0\0\0,b\0\0\xff\xff\xff\xff", 16),
                               std::string("/abc\0\0\0\0,????", 12),
                               std::string("#bundle\0", 8),
                               std::string("#bundle\0\0\0\0\0\0\0\0\1\0\0\0\x10", 20),
                               std::string("#bundle\0\0\0\0\0\0\0\0\1\0\0\0\0", 20),
                               deep,
                               std::string(65'507, '/'),
                               std::string(65'508, '\0')};
  for (std::size_t cut = 1; cut < good.size(); ++cut) bad.push_back(good.substr(0, cut));
  for (const std::string& packet : bad) {
    CAPTURE(packet.size());
    CHECK_FALSE(parse_packet(packet));
  }
  CHECK(parse_packet(good));
}

TEST_CASE("arguments become the values that the parameter takes") {
  const auto live = test::small_state();
  const auto now = live->current();
  struct Case {
    const char* path;
    std::vector<OscArgument> arguments;
    Json wanted;
  };
  const std::vector<Case> cases{
      {"/projections/wall/horizontal_fov", {real(120.5)}, 120.5},
      {"/projections/wall/horizontal_fov", {whole(120)}, 120},
      {"/quality/samples", {whole(4)}, 4},
      {"/quality/samples", {real(4.0)}, 4},
      {"/quality/cubemap_size", {word("auto")}, "auto"},
      {"/quality/cubemap_size", {whole(512)}, 512},
      {"/quality/cubemap_size", {{'N'}}, nullptr},
      {"/quality/cubemap_mipmaps", {{'T'}}, true},
      {"/quality/cubemap_mipmaps", {whole(0)}, false},
      {"/quality/cubemap_mipmaps", {real(1.0)}, true},
      {"/camera/position", {real(1.0), whole(2), real(3.5, 'd')}, Json::array({1.0, 2, 3.5})},
      {"/camera/look_to", {{'N'}}, nullptr},
      {"/scene/style/kind", {word("wireframe")}, "wireframe"},
      {"/projections/wall/kind", {word("fisheye")}, "fisheye"},
      {"/name", {word("Größe")}, "Größe"},
      {"/projections/wall/fov", {real(200.0)}, 200.0}, // unknown until its kind changes
  };
  for (const Case& one : cases) {
    CAPTURE(one.path);
    const auto edit = to_edit(*now, {one.path, one.arguments});
    REQUIRE(edit);
    CHECK(edit->path == one.path);
    CHECK(edit->value == one.wanted);
  }
}

TEST_CASE("arguments that do not fit are refused with the address") {
  const auto live = test::small_state();
  const auto now = live->current();
  const double nan = std::numeric_limits<double>::quiet_NaN(),
               infinity = std::numeric_limits<double>::infinity();
  const std::vector<OscMessage> bad{
      {"/projections/wall/horizontal_fov", {word("wide")}},
      {"/projections/wall/horizontal_fov", {real(nan)}},
      {"/projections/wall/horizontal_fov", {real(-infinity)}},
      {"/projections/wall/horizontal_fov", {real(1.0), real(2.0)}},
      {"/projections/wall/horizontal_fov", {{'T'}}},
      {"/projections/wall/horizontal_fov", {{'b'}}},
      {"/quality/samples", {real(1.5)}},
      {"/quality/samples", {real(1e30, 'd')}},
      {"/quality/cubemap_mipmaps", {whole(2)}},
      {"/quality/cubemap_mipmaps", {word("true")}},
      {"/camera/position", {real(1.0)}},
      {"/camera/position", {real(1.0), real(nan), real(1.0)}},
      {"/name", {whole(1)}},
      {"/name", {word("\xff\xfe")}},
      {"/projections", {whole(1)}},
      {"/projections/wall", {whole(1)}},
      {"/nonsense", {real(nan)}},
  };
  for (const OscMessage& message : bad) {
    CAPTURE(message.address);
    const auto edit = to_edit(*now, message);
    REQUIRE_FALSE(edit);
    CHECK(edit.error()[0].pointer == message.address);
    CHECK_FALSE(edit.error()[0].expected.empty());
  }
}

TEST_CASE("every parameter can be read, and set to what was read") {
  const auto live = test::small_state();
  for (const std::string& path : model::leaf_paths(*live->current()->show)) {
    CAPTURE(path);
    const auto now = live->current();
    const auto reply = to_reply(*now, path);
    REQUIRE(reply);
    const auto back = parse_packet(to_packet(*reply));
    REQUIRE(back);
    const auto edit = to_edit(*now, back->front());
    REQUIRE(edit);
    const auto answer = test::change(*live, {"test", {}, {*edit}});
    REQUIRE(answer);
    CHECK(answer->differences.empty());
  }
}

TEST_CASE("a camera texture: its deformations by messages, its grid not") {
  const auto live = test::small_state();
  REQUIRE(test::set(*live, "/projections/wall",
                    {{"kind", "camera_texture"},
                     {"columns", 1},
                     {"rows", 1},
                     {"offsets", Json::parse("[[[0, 0], [0, 0]], [[0, 0], [0.1, 0]]]")},
                     {"deformations", {{"turn", {{"kind", "swirl"}}}}}}));
  const auto edit = to_edit(*live->current(), {"/projections/wall/deformations/turn/angle", {real(12.5)}});
  REQUIRE(edit);
  REQUIRE(test::set(*live, edit->path, edit->value));
  const auto& shape = live->current()->show->projections.at("wall").shape;
  const auto& turn = std::get<model::CameraTexture>(shape).deformations.at("turn");
  CHECK(std::get<model::Swirl>(turn.bend).angle.degrees == 12.5);
  const auto refused = to_edit(*live->current(), {"/projections/wall/offsets", {real(0.1)}});
  REQUIRE_FALSE(refused);
  CHECK(refused.error()[0].found == "a grid");
  CHECK_FALSE(to_reply(*live->current(), "/projections/wall/offsets"));
  CHECK_FALSE(test::set(*live, "/projections/wall/offsets/0/0", Json::array({0.2, 0}))); // as a whole
}

TEST_CASE("questions about what has no single value") {
  const auto live = test::small_state();
  CHECK(to_reply(*live->current(), "/projections").error()[0].code == Code::wrong_type);
  CHECK(to_reply(*live->current(), "/projektions").error()[0].advice == "Did you mean \"projections\"?");
  CHECK_FALSE(to_reply(*live->current(), "/\xff"));
}

TEST_CASE("random and damaged packets never do harm") {
  std::mt19937 random(20080611);
  const auto live = test::small_state();
  const auto now = live->current();
  const std::vector<std::string> seeds{
      to_packet({"/projections/wall/horizontal_fov", {real(1.0)}}),
      to_packet({"/camera/position", {real(1.0), real(2.0), real(3.0)}}),
      bundle({to_packet({"/name", {word("abc")}}), bundle({to_packet({"/quality/samples", {whole(2)}})})})};
  std::size_t accepted = 0;
  for (int round = 0; round < 20'000; ++round) {
    std::string packet;
    if (round % 4 == 0) {
      packet.resize(random() % 256);
      for (char& c : packet) c = static_cast<char>(random());
    } else {
      packet = seeds[random() % seeds.size()];
      for (std::size_t hits = random() % 6; hits > 0; --hits)
        packet[random() % packet.size()] = static_cast<char>(random());
      if (random() % 4 == 0) packet.resize(random() % (packet.size() + 1));
    }
    const auto messages = parse_packet(packet);
    if (!messages) continue;
    for (const OscMessage& message : *messages) {
      if (message.arguments.empty()) {
        accepted += to_reply(*now, message.address) ? 1U : 0U;
      } else if (const auto edit = to_edit(*now, message)) {
        ++accepted;
        CHECK_NOTHROW(static_cast<void>(edit->value.dump())); // always valid UTF-8, never NaN
      }
    }
  }
  CHECK(accepted > 0);
  CHECK(live->current() == now);
}
