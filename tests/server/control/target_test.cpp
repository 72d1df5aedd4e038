#include "server/control/http/target.h"

#include <array>
#include <doctest/doctest.h>
#include <unistd.h>

#include "server/control/client/client.h"

using namespace cupola::control;

TEST_CASE("an address is taken apart and decoded") {
  const auto target = parse_target("/api/v1/outputs/main%20one.png?width=640&wait=shown&x=a+b%26c&flag#part");
  REQUIRE(target);
  CHECK(target->path == "/api/v1/outputs/main one.png");
  CHECK(target->query.at("width") == "640");
  CHECK(target->query.at("x") == "a b&c");
  CHECK(target->query.at("flag").empty());
  CHECK(parse_target("http://dome:8750/a?b=1")->path == "/a");
  CHECK(parse_target("http://dome:8750")->path == "/");
}

TEST_CASE("what is not an address is refused") {
  for (const char* text : {"", "a", "*", "/%", "/%4", "/%zz", "/%00", "/a?x=%0", "ftp://x/"}) {
    CAPTURE(text);
    CHECK_FALSE(parse_target(text));
  }
}

TEST_CASE("a host that can only be this machine") {
  std::array<char, 256> name{};
  REQUIRE(gethostname(name.data(), name.size() - 1) == 0);
  for (const std::string& host :
       {std::string("127.0.0.1"), std::string("127.0.0.1:8750"), std::string("[::1]:8750"),
        std::string("LOCALHOST"), std::string("192.168.7.3:1"), std::string(name.data())})
    CHECK_MESSAGE(is_own_host(host), host);
  for (const char* host :
       {"", "evil.example:8750", "127.0.0.1.evil.example", "localhost.evil.example", "[evil]"})
    CHECK_MESSAGE(!is_own_host(host), host);
}

TEST_CASE("where a daemon listens") {
  CHECK(parse_url("http://127.0.0.1:8750/")->port == "8750");
  CHECK(parse_url("dome")->host == "dome");
  CHECK(parse_url("dome")->port == "8750");
  CHECK(parse_url("[::1]:99")->host == "::1");
  CHECK(parse_url("[::1]:99")->port == "99");
  for (const char* text :
       {"", "http://", "https://x", "x:0", "x:70000", "x:1a", "x:", "http://x/path", "[::1", "u@x"})
    CHECK_MESSAGE(!parse_url(text), text);
}
