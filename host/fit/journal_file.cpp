#include "host/fit/journal_file.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "geom/error.h"
#include "host/atomic_file.h"
#include "host/json_document.h"

namespace wale::fit {
namespace {

using Json = nlohmann::ordered_json;

[[noreturn]] void damaged(const std::filesystem::path& file, const std::string& what) {
  user_error("{}: {}: this is no journal of a fit; --redo begins anew", file.string(), what);
}

constexpr int kVersion = 2;
constexpr double kMost = 1e9;  // of counts

double number_in(const JsonNode& node, const char* key, const std::filesystem::path& file) {
  const JsonNode* value = node.find(key);
  if (!value || !value->is_number()) damaged(file, std::string("\"") + key + "\" is not a number");
  return value->number;
}

int count_in(const JsonNode& node, const char* key, const std::filesystem::path& file) {
  const double value = number_in(node, key, file);
  if (!(value >= -1 && value < kMost)) damaged(file, std::string("\"") + key + "\" is not a count");
  return int(value);
}

const JsonNode& list_in(const JsonNode& node, const char* key, const std::filesystem::path& file) {
  const JsonNode* list = node.find(key);
  if (!list || list->kind != JsonNode::Kind::array) damaged(file, std::string("\"") + key + "\" is not a list");
  return *list;
}

std::vector<double> places_in(const JsonNode& list, size_t axes, const std::filesystem::path& file) {
  std::vector<double> places;
  for (const JsonNode& v : list.items)
    if (v.is_number() && v.number >= 0 && v.number <= 1) places.push_back(v.number);
  if (places.size() != axes || list.items.size() != axes) damaged(file, "places in the box are missing");
  return places;
}

}  // namespace

void write_journal(const FitJournal& journal, const std::string& identity, const std::filesystem::path& file) {
  Json out;
  out["wale_fit"] = kVersion;
  out["identity"] = identity;
  out["seconds"] = journal.seconds;
  out["chosen"] = journal.chosen;
  out["finished"] = Json::array();
  // JSON has no infinity. Descents that ended there are not done, nor are those after: they count by their place.
  for (const FitStart& s : journal.finished) {
    if (!std::isfinite(s.first_loss) || !std::isfinite(s.loss)) break;
    out["finished"].push_back({{"from", s.from},
                               {"to", s.to},
                               {"first_loss", s.first_loss},
                               {"loss", s.loss},
                               {"evaluations", s.evaluations},
                               {"converged", s.converged}});
  }
  out["steps"] = Json::array();
  for (const FitStep& s : journal.steps)
    if (std::isfinite(s.loss))
      out["steps"].push_back({{"start", s.start}, {"seconds", s.seconds}, {"loss", s.loss}, {"places", s.places}});
  write_text_file(file, out.dump() + "\n");
}

std::optional<FitJournal> read_journal(const std::filesystem::path& file, const std::string& identity, size_t axes) {
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) return std::nullopt;
  const JsonNode root = read_json(file);
  const JsonNode* of = root.find("identity");
  if (root.kind != JsonNode::Kind::object || !root.find("wale_fit") || !of) damaged(file, "\"identity\" is missing");
  if (number_in(root, "wale_fit", file) != kVersion)
    user_error("{}: the journal of another version of Wale; --redo begins anew", file.string());
  if (of->text != identity)
    user_error("{}: the journal of a fit of another scene, other photographs or other settings; --redo begins anew",
               file.string());
  FitJournal out;
  out.seconds = number_in(root, "seconds", file);
  for (const JsonNode& places : list_in(root, "chosen", file).items)
    out.chosen.push_back(places_in(places, axes, file));
  for (const JsonNode& node : list_in(root, "finished", file).items) {
    FitStart s;
    s.from = places_in(list_in(node, "from", file), axes, file);
    s.to = places_in(list_in(node, "to", file), axes, file);
    s.first_loss = number_in(node, "first_loss", file);
    s.loss = number_in(node, "loss", file);
    s.evaluations = count_in(node, "evaluations", file);
    const JsonNode* converged = node.find("converged");
    s.converged = converged && converged->boolean;
    out.finished.push_back(std::move(s));
  }
  for (const JsonNode& node : list_in(root, "steps", file).items)
    out.steps.push_back({count_in(node, "start", file), number_in(node, "seconds", file), number_in(node, "loss", file),
                         places_in(list_in(node, "places", file), axes, file)});
  if (out.finished.size() > out.chosen.size()) damaged(file, "more descents than starts");
  return out;
}

}  // namespace wale::fit
