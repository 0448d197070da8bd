#include "geom/mesh_sequence.h"

#include <algorithm>
#include <cmath>

#include "geom/error.h"
#include "geom/numbered_name.h"

namespace wale {
namespace {

std::unique_ptr<FrameStore> open_store(const SequenceSource& source, const MeshReader& read) {
  if (!source.cache.empty()) return point_cache(ByteSource::of_file(source.cache), read(source.base));
  std::string suffix = source.frames.extension().string();
  std::transform(suffix.begin(), suffix.end(), suffix.begin(), [](unsigned char c) { return std::tolower(c); });
  if (suffix == ".bin") return binary_frames(ByteSource::of_file(source.frames));
  return numbered_files(source.frames, read);
}

}  // namespace

MeshSequence::MeshSequence(const SequenceSource& source, const MeshReader& read)
    : MeshSequence(source, open_store(source, read),
                   source.cache.empty() ? 1.0 : frames_per_sample(ByteSource::of_file(source.cache))) {}

MeshSequence::MeshSequence(const SequenceSource& source, std::unique_ptr<FrameStore> store, double frames_per_number)
    : source_(source), store_(std::move(store)), frames_per_number_(frames_per_number) {
  if (source_.step == 0) bug("mesh sequence: a step of 0");
  for (const long n : store_->numbers())
    if (!before(n, source_.first) && !(source_.last && before(*source_.last, n))) numbers_.push_back(n);
  if (source_.step < 0) std::reverse(numbers_.begin(), numbers_.end());
  if (numbers_.empty())
    user_error("{}: no frames from number {}{}; there are {} to {}", store_->name(source_.first), source_.first,
               source_.last ? fmt::format(" to {}", *source_.last) : " on", store_->numbers().front(),
               store_->numbers().back());
}

double MeshSequence::frame_of(long number) const {
  return double(number - source_.first) * frames_per_number_ / double(source_.step);
}

bool MeshSequence::there(long number) const {
  return std::binary_search(numbers_.begin(), numbers_.end(), number, [&](long a, long b) { return before(a, b); });
}

MeshSequence::Place MeshSequence::place(double frame) const {
  // Whole frames stay whole in spite of a rate such as 1/24 in float. Neighbours are a step apart; samples of a cache
  // that are not one a frame are their own neighbours.
  constexpr double kWhole = 1e-4, kFarthest = 1e9;
  const bool own = frames_per_number_ != 1;
  const double at = std::clamp(own ? frame * double(source_.step) / frames_per_number_ : frame, -kFarthest, kFarthest);
  const long stride = own ? 1 : source_.step;
  const auto number = [&](double whole) { return source_.first + std::lround(whole) * stride; };
  const double whole = std::floor(at);
  if (std::abs(at - std::round(at)) <= kWhole) return {number(std::round(at)), number(std::round(at)), 0};
  // There is no way from one mesh to another one: the one before stays.
  if (source_.changing) return {number(whole), number(whole), 0};
  Place p{number(whole), number(whole + 1), at - whole};
  // Behind the last frame the motion goes on: what moves is as blurred there as before.
  if (!there(p.after) && there(p.before) && there(number(whole - 1)) && !before(p.after, numbers_.back()))
    p = {number(whole - 1), p.before, 1 + p.share};
  return p;
}

// "there are 0 to 59 without 12, 30 to 32".
std::string MeshSequence::range_text() const {
  constexpr size_t kMost = 4;
  std::vector<std::string> gaps;
  std::optional<long> last;
  size_t more = 0;
  for (const long n : numbers_) {
    if (frames_per_number_ != 1 || (n - source_.first) % source_.step != 0) continue;
    if (last && n != *last + source_.step) {
      const long from = *last + source_.step, to = n - source_.step;
      if (gaps.size() == kMost)
        ++more;
      else
        gaps.push_back(from == to ? std::to_string(from) : fmt::format("{} to {}", from, to));
    }
    last = n;
  }
  std::string text = numbers_.size() == 1 ? fmt::format("there is {}", numbers_.front())
                                          : fmt::format("there are {} to {}", numbers_.front(), numbers_.back());
  if (!gaps.empty()) text += fmt::format(" without {}{}", fmt::join(gaps, ", "), more ? ", ..." : "");
  return text;
}

std::string MeshSequence::missing(long number) const {
  return fmt::format("frame {:g}: {} is not there; {}", frame_of(number), store_->name(number), range_text());
}

void MeshSequence::require(double frame) const {
  const Place p = place(frame);
  if (source_.hold) return;
  for (const long number : {p.before, p.after})
    if (!there(number)) user_error("{}", missing(number));
}

BaseMesh MeshSequence::rest() const {
  if (!rest_) {
    const Place p = place(double(source_.rest));
    if (!there(p.before)) user_error("the rest, {}", missing(p.before));
    rest_ = std::make_unique<BaseMesh>(load(p.before));
  }
  return *rest_;
}

// The reader's messages name the file; which frame it is stands before them.
BaseMesh MeshSequence::load(long number) const {
  try {
    return store_->read(number);
  } catch (const Error& error) {
    if (error.fault() != Fault::user) throw;
    user_error("frame {:g}: {}", frame_of(number), error.what());
  }
}

std::shared_ptr<const BaseMesh> MeshSequence::read(long number) const {
  constexpr size_t kKept = 2;
  if (!there(number)) user_error("{}", missing(number));
  for (const auto& [known, mesh] : kept_)
    if (known == number) return mesh;
  if (const auto tried = faults_.find(number); tried != faults_.end() && !tried->second.empty())
    user_error("{}", tried->second);
  try {
    const bool at_rest = number == place(double(source_.rest)).before;
    auto mesh = std::make_shared<BaseMesh>(at_rest ? rest() : load(number));
    if (!source_.changing) take_topology_of_rest(*mesh, number);
    faults_[number].clear();
    kept_.emplace_back(number, mesh);
    if (kept_.size() > kKept) kept_.pop_front();
    return mesh;
  } catch (const Error& error) {
    if (error.fault() == Fault::user && source_.hold) faults_[number] = error.what();
    throw;
  }
}

void MeshSequence::take_topology_of_rest(BaseMesh& mesh, long number) const {
  rest();
  if (mesh.position.size() != rest_->position.size() || mesh.triangle != rest_->triangle)
    user_error(
        "frame {:g}: {} has {} vertices and {} triangles{}, the rest frame {} and {}; write \"topology\": \"changing\" "
        "where every frame is a mesh of its own",
        frame_of(number), store_->name(number), mesh.position.size(), mesh.triangle.size(),
        mesh.position.size() == rest_->position.size() && mesh.triangle.size() == rest_->triangle.size()
            ? " between other corners"
            : "",
        rest_->position.size(), rest_->triangle.size());
  mesh.uv = rest_->uv;
}

std::shared_ptr<const BaseMesh> MeshSequence::read_or_hold(long number, std::vector<std::string>* notes) const {
  if (!source_.hold) return read(number);
  // That number, or the last before it that can be read; the first stands for what is before it.
  auto candidate = held(number);
  std::string fault = there(number) ? "" : missing(number);
  while (true) {
    try {
      auto mesh = read(*candidate);
      if (*candidate != number && notes)
        notes->push_back(fmt::format("{}; {} is held", fault, store_->name(*candidate)));
      return mesh;
    } catch (const Error& error) {
      if (error.fault() != Fault::user) throw;
      if (fault.empty()) fault = error.what();
    }
    if (candidate == numbers_.begin()) user_error("{}; no frame before it can be held", fault);
    --candidate;
  }
}

std::vector<long>::const_iterator MeshSequence::held(long number) const {
  const auto after =
      std::upper_bound(numbers_.begin(), numbers_.end(), number, [&](long a, long b) { return before(a, b); });
  return after == numbers_.begin() ? after : after - 1;
}

// What read_or_hold() reads for a number. Of frames that are an error it is any.
long MeshSequence::shown(long number) const {
  auto candidate = held(number);
  if (!source_.hold) return *candidate;
  const auto readable = [&](long n) {
    if (const auto tried = faults_.find(n); tried != faults_.end()) return tried->second.empty();
    try {
      read(n);
      return true;
    } catch (const Error& error) {
      if (error.fault() != Fault::user) throw;
      return false;
    }
  };
  while (candidate != numbers_.begin() && !readable(*candidate)) --candidate;
  return *candidate;
}

BaseMesh MeshSequence::at(double frame, std::vector<std::string>* notes) const {
  const Place p = place(frame);
  BaseMesh mesh = *read_or_hold(p.before, notes);
  if (p.share == 0) return mesh;
  const auto after = read_or_hold(p.after, notes);
  for (size_t i = 0; i < mesh.position.size(); ++i)
    mesh.position[i] += p.share * (after->position[i] - mesh.position[i]);
  compute_normals(mesh);
  return mesh;
}

std::vector<std::filesystem::path> MeshSequence::files(double frame) const {
  if (!source_.cache.empty()) return {source_.base, source_.cache};
  if (!NumberedName::is_one(source_.frames)) return {source_.frames};
  // Also one that is not there yet: behind the last frame the motion goes on, until another one comes up.
  const Place p = place(frame);
  std::vector<std::filesystem::path> out = {store_->name(p.after + source_.step)};
  for (const long number : {p.before, p.after, place(double(source_.rest)).before}) {
    out.push_back(store_->name(number));
    if (!source_.hold) continue;
    out.push_back(store_->name(shown(number)));
    if (!there(number)) out.push_back(NumberedName(source_.frames).folder());
  }
  return out;
}

uint64_t MeshSequence::hash(double frame) const {
  const Place p = place(frame);
  uint64_t h = kHashSeed;
  const auto add = [&](auto value) {
    h = hash_bytes(std::string_view(reinterpret_cast<const char*>(&value), sizeof value), h);
  };
  add(store_->hash(*held(place(double(source_.rest)).before)));
  for (const long number : {p.before, p.after}) add(store_->hash(shown(number)));
  add(p.share);
  return h;
}

}  // namespace wale
