#include "server/control/http/body.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <unordered_set>
#include <vector>

namespace cupola::control {

using model::Code;
using model::Json;
using model::Problem;

namespace {

constexpr int deepest = 64;
constexpr std::size_t most_keys = 10'000;

model::Position position_at(std::string_view text, std::size_t byte) {
  const std::string_view before = text.substr(0, std::min(byte, text.size()));
  const std::size_t line_start = before.rfind('\n') + 1; // npos + 1 is 0
  return {"", static_cast<std::size_t>(std::count(before.begin(), before.end(), '\n')) + 1,
          before.size() - line_start + 1};
}

/// Thrown through the parser to stop it; caught below.
struct Refused {
  Problem problem;
};

/// Called by the parser for every event: keeps the bounds.
class Watch {
public:
  bool operator()(int depth, Json::parse_event_t event, const Json& parsed) {
    using Event = Json::parse_event_t;
    if (depth > deepest && (event == Event::object_start || event == Event::array_start))
      throw Refused{
          {Code::json_too_deep, "", "at most " + std::to_string(deepest) + " levels", "more", {}, {}}};
    if (event == Event::object_start) {
      keys_.emplace_back();
    } else if (event == Event::object_end) {
      keys_.pop_back();
    } else if (event == Event::key) {
      const auto& key = parsed.get_ref<const std::string&>();
      if (!keys_.back().insert(key).second)
        throw Refused{{Code::json_duplicate_key, "", "every key once", '"' + key + "\" twice", {}, {}}};
      if (keys_.back().size() > most_keys)
        throw Refused{{Code::too_many,
                       "",
                       "at most " + std::to_string(most_keys) + " keys in an object",
                       "more",
                       {},
                       {}}};
    }
    return true;
  }

private:
  std::vector<std::unordered_set<std::string>> keys_;
};

} // namespace

model::Result<Json> parse_body(std::string_view text) {
  try {
    Watch watch;
    return Json::parse(text, std::ref(watch));
  } catch (const Refused& refused) {
    return model::failure(refused.problem);
  } catch (const Json::parse_error& error) {
    // The library's text begins with its own place; what follows the last ": " of that is the reason.
    const std::string words = error.what();
    const std::size_t reason = words.find(": ");
    return model::failure({Code::json_syntax,
                           "",
                           "JSON",
                           reason == std::string::npos ? words : words.substr(reason + 2),
                           {},
                           position_at(text, error.byte > 0 ? error.byte - 1 : 0)});
  } catch (const Json::exception& error) {
    return model::failure({Code::json_syntax, "", "numbers within double precision", error.what(), {}, {}});
  }
}

} // namespace cupola::control
