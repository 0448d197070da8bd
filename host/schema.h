#pragma once
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "host/json_document.h"

namespace wale {

/// How a number in a file is turned into SI: lengths follow the file's "units", angles are written in degrees.
enum class Unit { none, length, angle };

/// Valid numbers, in the units of the file: min <= x <= max, or min < x when `open`, or min < x < max when `open_max`
/// too. With `gap` > 0 also |x| >= gap or x = 0. The text of an error is made from the same fields.
struct Range {
  double min = std::numeric_limits<double>::lowest(), max = std::numeric_limits<double>::max();
  bool open = false;
  double gap = 0;
  bool open_max = false;
  bool contains(double x) const;
  std::string text() const;
};

class FileFence;
struct SchemaType;
using Type = std::shared_ptr<const SchemaType>;

/// One key of an object. `preset` (JSON text; lengths in metres, angles in degrees) is put in when the key is absent.
struct Property {
  std::string name;
  Type type;
  std::string doc;
  std::string preset = {};
  bool required = false;
};

/// Keys of which at most one (or exactly one) may be given.
struct KeyGroup {
  std::vector<std::string> keys;
  bool exactly_one = false;
};

/// A node of the table that describes a file format. The table is checked against (check_schema) and printed as JSON
/// Schema (schema_text); nothing about the format is said twice.
struct SchemaType {
  enum class Kind {
    truth,
    integer,
    number,
    string,
    word,
    choice_of_integers,
    file,
    color,
    radiance,
    vector,
    list,
    map,
    object,
    tagged,
    either,
    any
  } kind;
  Unit unit = Unit::none;
  Range range;                       ///< integer, number, and every component of a vector
  std::vector<std::string> words;    ///< word; tagged: values of the tag
  std::vector<int> integers;         ///< choice_of_integers
  bool only_true = false;            ///< truth
  Type item;                         ///< list, map
  size_t length = 0;                 ///< vector; list: fewest items
  bool whole = false;                ///< vector of integers
  std::vector<Property> properties;  ///< object
  std::vector<KeyGroup> groups;      ///< object
  std::string tag, default_tag;      ///< tagged: the key that tells the alternatives apart
  std::vector<Type> alternatives;    ///< tagged: objects, one per word; either: told apart by JSON kind, or by
  std::vector<std::string> told_by;  ///< either: a key that this alternative has, "" = by kind
};

Type truth();
Type only_true();
Type integer(Range range);
Type number(Range range, Unit unit = Unit::none);
Type text();
Type word(std::vector<std::string> words);
Type one_of(std::vector<int> integers);
Type file();
Type color();
Type radiance();
Type vector(size_t length, Range range, Unit unit = Unit::none, bool whole = false);
Type list(Type item, size_t fewest = 0);
Type map(Type item);
Type object(std::vector<Property> properties, std::vector<KeyGroup> groups = {});
Type tagged(std::string tag, std::vector<std::pair<std::string, Type>> alternatives, std::string default_tag = "");
Type either(std::vector<std::pair<std::string, Type>> alternatives);
/// A value that is checked elsewhere.
Type any();

/// What a check needs to know besides the table.
struct SchemaContext {
  double metres_per_unit = 1;
  std::filesystem::path folder;  ///< relative files start here
  FileFence* fence = nullptr;    ///< asked for every file that a document names; null: any may be
};

/// Checks a document strictly and turns it into SI in place: lengths to metres, angles to radians, colours to three
/// scene-linear numbers, files to absolute paths that exist; absent keys with a preset are filled in. Throws a user
/// error "place: path: what is wrong; nearest valid choice" at the first fault in file order.
void check_schema(const SchemaType& type, JsonNode& node, const SchemaContext& context, const std::string& path = "");

/// The table as JSON Schema, draft 2020-12, indented.
std::string schema_text(const SchemaType& type, const std::string& title);

/// sRGB-encoded value to linear and back (IEC 61966-2-1); both in [0,1] for inputs in [0,1].
double srgb_to_linear(double encoded);
double linear_to_srgb(double linear);

}  // namespace wale
