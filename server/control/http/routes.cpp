#include "server/control/http/routes.h"

#include <algorithm>
#include <atomic>
#include <charconv>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "server/control/http/body.h"
#include "server/control/http/page.h"
#include "server/control/http/target.h"
#include "server/control/problem_json.h"

namespace cupola::control {

using model::Code;
using model::Json;
using model::Problem;
using model::Problems;
using state::Answer;
using state::Snapshot;

namespace {

constexpr std::string_view api = "/api/v1";

std::string text_of(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace) + '\n';
}

Response json_response(int status, const Json& json) {
  return {status, "application/json", text_of(json), {}};
}

Response refused(int status, const Problems& problems) {
  Response response = json_response(status, {{"problems", problems_json(problems)}});
  if (status == 503) response.header_lines.emplace_back("Retry-After", "1");
  return response;
}

Response refused(int status, Code code, std::string expected, std::string found, std::string advice = {}) {
  return refused(status, {{code, "", std::move(expected), std::move(found), std::move(advice), {}}});
}

/// The status that says best why a change was not taken.
int status_of(const Problems& problems, bool path_in_address) {
  for (const Problem& problem : problems) {
    if (problem.code == Code::revision_moved) return 412;
    if (problem.code == Code::overloaded || problem.code == Code::stopping) return 503;
    if (problem.code == Code::unknown_path && path_in_address) return 404;
  }
  return 422;
}

std::string etag(model::Revision revision) { return '"' + std::to_string(revision) + '"'; }

/// The revisions of an If-Match or If-None-Match line; nullopt where it is not a list of quoted numbers.
std::optional<std::vector<model::Revision>> revisions_of(std::string_view line) {
  std::vector<model::Revision> out;
  while (!line.empty()) {
    const std::size_t end = std::min(line.find(','), line.size());
    std::string_view tag = line.substr(0, end);
    line.remove_prefix(std::min(end + 1, line.size()));
    while (tag.starts_with(' ')) tag.remove_prefix(1);
    while (tag.ends_with(' ')) tag.remove_suffix(1);
    if (tag.size() < 3 || tag.front() != '"' || tag.back() != '"') return std::nullopt;
    tag = tag.substr(1, tag.size() - 2);
    model::Revision revision = 0;
    const auto [rest, error] = std::from_chars(tag.data(), tag.data() + tag.size(), revision);
    if (error != std::errc{} || rest != tag.data() + tag.size()) return std::nullopt;
    out.push_back(revision);
  }
  return out;
}

/// Whether a browser page of another site asks: then nothing may be changed.
bool is_foreign(const Request& request) {
  const std::string& origin = request.header("origin");
  const std::string& site = request.header("sec-fetch-site");
  if (origin.empty() && site.empty()) return false; // not a browser
  const std::string& host = request.header("host");
  if (!is_own_host(host)) return true; // a foreign name that resolves here
  if (!origin.empty() && origin != "http://" + host && origin != "https://" + host) return true;
  return site == "cross-site" || site == "same-site";
}

bool is_json_type(std::string type, bool merge_patch) {
  type.resize(std::min(type.find(';'), type.size()));
  while (type.ends_with(' ')) type.pop_back();
  std::transform(type.begin(), type.end(), type.begin(), [](unsigned char c) { return std::tolower(c); });
  return type == "application/json" || (merge_patch && type == "application/merge-patch+json");
}

Json changes_json(const std::vector<model::Difference>& differences) {
  Json out = Json::array();
  for (const model::Difference& difference : differences)
    out.push_back({{"pointer", difference.pointer}, {"cost", model::cost_name(difference.cost)}});
  return out;
}

std::string kind_name(model::Kind kind) {
  switch (kind) {
  case model::Kind::boolean:
    return "boolean";
  case model::Kind::integer:
    return "integer";
  case model::Kind::number:
    return "number";
  case model::Kind::text:
    return "text";
  case model::Kind::choice:
    return "choice";
  case model::Kind::vector3:
    return "vector3";
  case model::Kind::grid:
    return "grid";
  case model::Kind::integer_or_auto:
    return "integer or auto";
  default:
    return "object";
  }
}

Json parameter_json(const Snapshot& now, const std::string& path) {
  Json out = {{"path", path}};
  const auto value = state::value_at(now, path);
  out["value"] = value ? *value : Json();
  const auto found = model::find(*now.show, path);
  if (!found) return out;
  if (found->is_kind) {
    out["kind"] = "choice";
    for (const model::Alternative& alternative : found->type->alternatives)
      out["choices"].push_back(alternative.name);
    out["cost"] = model::cost_name(found->type->kind_cost);
    out["text"] = found->type->doc;
    return out;
  }
  const model::Parameter& row = *found->row;
  out["kind"] = kind_name(row.kind);
  if (row.unit != model::Unit::none) out["unit"] = model::unit_symbol(row.unit);
  if (row.range) out["range"] = {row.range->min, row.range->max};
  if (!row.choices.empty()) out["choices"] = row.choices;
  out["cost"] = model::cost_name(row.cost);
  out["text"] = row.doc;
  return out;
}

/// How long a change with wait=shown waits: ?timeout=SECONDS, 10 by default, at most 60.
std::optional<std::chrono::milliseconds> patience_of(const Target& target) {
  const auto asked = target.query.find("timeout");
  if (asked == target.query.end()) return std::chrono::seconds(10);
  double seconds = 0.0;
  const char* end = asked->second.data() + asked->second.size();
  const auto [rest, error] = std::from_chars(asked->second.data(), end, seconds);
  if (error != std::errc{} || rest != end || !(seconds >= 0.0 && seconds <= 60.0)) return std::nullopt;
  return std::chrono::milliseconds(static_cast<std::int64_t>(seconds * 1000.0));
}

} // namespace

struct Routes::Impl {
  Impl(state::LiveState& state, Services given)
      : live(state)
      , services(std::move(given))
      , schema(text_of(services.schema)) {
    if (services.snapshot) pictures.emplace(services.snapshot, services.picture_patience);
  }

  void dispatch(const Request& request, const Respond& respond);
  void show(const Request& request, const Target& target, const std::string& pointer, const Respond& respond);
  void change(const Request& request, const Target& target, const std::string& pointer,
              const Respond& respond);
  void picture(const Target& target, const std::string& file, const Respond& respond);
  Response read_show(const Request& request, const std::string& pointer) const;
  Response status() const;
  Response outputs() const;
  Response parameters() const;

  state::LiveState& live;
  Services services;
  std::string schema;
  std::chrono::steady_clock::time_point started = std::chrono::steady_clock::now();
  std::optional<Pictures> pictures;
};

Response Routes::Impl::read_show(const Request& request, const std::string& pointer) const {
  const auto now = live.current();
  if (const auto known = revisions_of(request.header("if-none-match")))
    if (std::find(known->begin(), known->end(), now->revision) != known->end())
      return {304, "", "", {{"ETag", etag(now->revision)}}};
  const auto value = state::value_at(*now, pointer);
  if (!value) return refused(404, value.error());
  Response response = json_response(200, *value);
  response.header_lines.emplace_back("ETag", etag(now->revision));
  return response;
}

Response Routes::Impl::status() const {
  const auto now = live.current();
  const std::chrono::duration<double> uptime = std::chrono::steady_clock::now() - started;
  Json out = {{"version", services.version},
              {"revision", now->revision},
              {"name", now->show->name},
              {"uptime", uptime.count()},
              {"frame_rate", now->show->frame_rate}};
  if (services.status) out.update(services.status());
  Json warnings = problems_json(now->warnings);
  for (Json& problem : out["problems"]) warnings.push_back(std::move(problem));
  out["problems"] = std::move(warnings);
  return json_response(200, out);
}

Response Routes::Impl::outputs() const {
  const auto now = live.current();
  const Json added = services.status ? services.status() : Json::object();
  Json list = Json::array();
  for (const auto& [name, output] : now->show->outputs) {
    Json one = {{"name", name},
                {"kind", (*now->document)["outputs"][name]["kind"]},
                {"width", output.width},
                {"height", output.height},
                {"png", std::string(api) + "/outputs/" + name + ".png"},
                {"jpg", std::string(api) + "/outputs/" + name + ".jpg"}};
    if (added.contains("outputs") && added["outputs"].contains(name)) one.update(added["outputs"][name]);
    list.push_back(std::move(one));
  }
  return json_response(200, {{"outputs", std::move(list)}});
}

Response Routes::Impl::parameters() const {
  const auto now = live.current();
  Json list = Json::array();
  for (const std::string& path : model::leaf_paths(*now->show)) list.push_back(parameter_json(*now, path));
  Response response = json_response(200, {{"revision", now->revision}, {"parameters", std::move(list)}});
  response.header_lines.emplace_back("ETag", etag(now->revision));
  return response;
}

void Routes::Impl::picture(const Target& target, const std::string& file, const Respond& respond) {
  const std::size_t dot = std::min(file.rfind('.'), file.size());
  const std::string ending = file.substr(dot);
  PictureKey key{file.substr(0, dot), ending == ".png" ? PictureFormat::png : PictureFormat::jpeg, 0};
  const auto now = live.current();
  if ((ending != ".png" && ending != ".jpg") || !now->show->outputs.contains(key.output)) {
    std::string known;
    for (const auto& [name, output] : now->show->outputs)
      known.append(known.empty() ? "" : ", ").append(name).append(".png, ").append(name).append(".jpg");
    return respond(refused(404, Code::unknown_resource, "one of " + known, '"' + file + '"'));
  }
  if (const auto asked = target.query.find("width"); asked != target.query.end()) {
    const char* end = asked->second.data() + asked->second.size();
    const auto [rest, error] = std::from_chars(asked->second.data(), end, key.width);
    if (error != std::errc{} || rest != end || key.width < 16 || key.width > 16384)
      return respond(refused(400, Code::bad_request, "a width from 16 to 16384", '"' + asked->second + '"'));
  }
  if (!pictures) return respond(refused(503, Code::no_picture, "a source of pictures", "none"));
  const char* type = key.format == PictureFormat::png ? "image/png" : "image/jpeg";
  pictures->request(key, [respond, type](const model::Result<std::string>& bytes) {
    respond(bytes ? Response{200, type, *bytes, {}} : refused(503, bytes.error()));
  });
}

/// PATCH, PUT and DELETE: one change, answered when it is accepted or shown.
void Routes::Impl::change(const Request& request, const Target& target, const std::string& pointer,
                          const Respond& respond) {
  if (is_foreign(request))
    return respond(
        refused(403, Code::foreign_origin, "a page of this daemon",
                "origin \"" + request.header("origin") + "\", host \"" + request.header("host") + '"'));
  model::Change change{"http " + request.peer, std::nullopt, {}};
  if (request.method == "DELETE") {
    change.edits = {{pointer, nullptr}};
  } else {
    const bool patch = request.method == "PATCH";
    if (!is_json_type(request.header("content-type"), patch)) {
      Response response = refused(415, Code::bad_request,
                                  patch ? "content of type application/merge-patch+json or application/json"
                                        : "content of type application/json",
                                  '"' + request.header("content-type") + '"');
      response.header_lines.emplace_back("Accept-Patch", "application/merge-patch+json, application/json");
      return respond(std::move(response));
    }
    auto value = parse_body(request.body);
    if (!value) return respond(refused(400, value.error()));
    if (patch && !value->is_object())
      return respond(
          refused(400, Code::bad_request, "a JSON object to merge into the show", value->type_name()));
    // To replace a struct instead of merging into it, it is first taken away; a list's entry cannot be.
    const bool in_list = std::all_of(pointer.begin() + static_cast<std::ptrdiff_t>(pointer.rfind('/') + 1),
                                     pointer.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
    if (!patch && value->is_object() && (pointer.empty() || !in_list)) change.edits = {{pointer, nullptr}};
    change.edits.push_back({pointer, std::move(*value)});
  }
  if (const std::string& match = request.header("if-match"); !match.empty() && match != "*") {
    const auto known = revisions_of(match);
    if (!known || known->empty())
      return respond(
          refused(400, Code::bad_request, "If-Match with the ETag of the show", '"' + match + '"'));
    const model::Revision now = live.current()->revision;
    change.expects = std::find(known->begin(), known->end(), now) != known->end() ? now : known->front();
  }
  const auto wait = target.query.find("wait");
  if (wait != target.query.end() && wait->second != "shown" && wait->second != "accepted")
    return respond(refused(400, Code::bad_request, "wait=shown or wait=accepted", "wait=" + wait->second));
  const bool until_shown = wait != target.query.end() && wait->second == "shown";
  const auto patience = patience_of(target);
  if (!patience)
    return respond(refused(400, Code::bad_request, "a timeout from 0 to 60 seconds",
                           '"' + target.query.at("timeout") + '"'));

  const bool path_in_address = request.method != "PATCH";
  live.submit(std::move(change), [&live = live, respond, until_shown, wait_for = *patience,
                                  path_in_address](const Answer& answer) {
    if (!answer) return respond(refused(status_of(answer.error(), path_in_address), answer.error()));
    Json out = {{"revision", answer->revision},
                {"cost", model::cost_name(answer->cost)},
                {"changes", changes_json(answer->differences)},
                {"warnings", problems_json(answer->warnings)}};
    const auto send = [respond, tag = etag(answer->revision)](int status, const Json& json) {
      Response response = json_response(status, json);
      response.header_lines.emplace_back("ETag", tag);
      respond(std::move(response));
    };
    if (!until_shown) return send(200, out);
    live.when_shown(answer->revision, wait_for,
                    [send, out](std::optional<std::uint64_t> frame, const Problems& why_not) mutable {
                      out["frame"] = frame ? Json(*frame) : Json();
                      if (!frame) out["problems"] = problems_json(why_not);
                      send(frame ? 200 : 202, out);
                    });
  });
}

void Routes::Impl::dispatch(const Request& request, const Respond& respond) {
  if (request.method == "OPTIONS" && request.target == "*")
    return respond({204, "", "", {{"Allow", "GET, HEAD, OPTIONS, PATCH, PUT, DELETE"}}});
  const auto target = parse_target(request.target);
  if (!target)
    return respond(refused(400, Code::bad_request, "a path that begins with '/'", "a malformed address"));
  const std::string& path = target->path;
  const std::string show_path = std::string(api) + "/show", outputs_path = std::string(api) + "/outputs";
  const bool is_show = path == show_path, is_value = path.starts_with(show_path + '/');
  const bool is_picture = path.starts_with(outputs_path + '/');
  const bool is_known = is_show || is_value || is_picture || path == "/" || path == outputs_path ||
                        path == std::string(api) + "/status" || path == std::string(api) + "/parameters" ||
                        path == std::string(api) + "/schema";
  if (!is_known)
    return respond(refused(404, Code::unknown_resource,
                           "/, or /api/v1/ with status, show, parameters, schema or outputs",
                           '"' + path + '"'));

  std::string allow = "GET, HEAD, OPTIONS";
  if (is_show) allow += ", PATCH, PUT";
  if (is_value) allow += ", PUT, DELETE";
  if (request.method == "OPTIONS") return respond({204, "", "", {{"Allow", allow}}});
  const bool reads = request.method == "GET" || request.method == "HEAD";
  const bool changes = (is_show && (request.method == "PATCH" || request.method == "PUT")) ||
                       (is_value && (request.method == "PUT" || request.method == "DELETE"));
  if (!reads && !changes) {
    Response response = refused(405, Code::bad_request, allow, request.method);
    response.header_lines.emplace_back("Allow", allow);
    return respond(std::move(response));
  }
  const std::string pointer = is_value ? path.substr(show_path.size()) : "";
  if (changes) return change(request, *target, pointer, respond);
  if (is_show || is_value) return respond(read_show(request, pointer));
  if (is_picture) return picture(*target, path.substr(outputs_path.size() + 1), respond);
  if (path == "/") return respond(live_page());
  if (path == outputs_path) return respond(outputs());
  if (path.ends_with("/status")) return respond(status());
  if (path.ends_with("/parameters")) return respond(parameters());
  respond({200, "application/schema+json", schema, {}});
}

Routes::Routes(state::LiveState& live, Services services)
    : impl_(std::make_unique<Impl>(live, std::move(services))) {}
Routes::~Routes() = default;

void Routes::handle(const Request& request, const Respond& respond) {
  // A handler that fails half-way has not answered yet: every path answers last.
  try {
    impl_->dispatch(request, respond);
  } catch (const std::exception& error) {
    respond(refused(500, Code::bad_request, "a request that can be carried out", error.what()));
  }
}

} // namespace cupola::control
