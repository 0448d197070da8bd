#pragma once
#include <deque>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "geom/frame_store.h"

namespace wale {

/// A base mesh that moves, as a scene names it. Frame n of the scene is number first + n * step of the files, or of the
/// file of frames.
struct SequenceSource {
  std::filesystem::path frames;  ///< "cloth_####.obj", or a file of frames (.bin); empty with a cache
  std::filesystem::path base, cache;
  long first = 0, step = 1;
  std::optional<long> last;  ///< number beyond which nothing is read; absent: the last that there is
  long rest = 0;             ///< frame on which the cloth is knitted
  bool hold = false;         ///< a frame that is missing or damaged is that before it; else it is an error
  bool changing = false;     ///< every frame may have other triangles

  bool operator==(const SequenceSource&) const = default;
};

/// The frames of a moving base mesh, read when they are asked for; the last two stay, as a shutter that is open looks
/// at them again and again. Frames between two are on the straight way from one to the other.
class MeshSequence {
 public:
  /// Finds the frames. Throws a user error when there are none.
  MeshSequence(const SequenceSource& source, const MeshReader& read);
  /// The same over given frames; `frames_per_number`: as of a point cache.
  MeshSequence(const SequenceSource& source, std::unique_ptr<FrameStore> store, double frames_per_number = 1);

  /// The mesh at rest. Errors of it are never held.
  BaseMesh rest() const;

  /// The mesh at a frame; where topology is fixed, triangles and UV are those of the rest. Throws a user error that
  /// names the frame and its file: not there, no mesh, NaN, other triangles; or, where such frames are held, adds one
  /// line to `notes`. Between two frames of changing topology it is the one before.
  BaseMesh at(double frame, std::vector<std::string>* notes = nullptr) const;

  /// Throws what at() would where it can be known without reading meshes.
  void require(double frame) const;

  /// Hash of the bytes that at() would show: of the frame before, where a frame is damaged and held. Where damaged ones
  /// are held it reads the frame, unless at() has.
  uint64_t hash(double frame) const;

  /// Files and folders that at() depends on, there or not. Where damaged frames are held it reads them, as hash() does.
  std::vector<std::filesystem::path> files(double frame) const;

  const SequenceSource& source() const { return source_; }

 private:
  struct Place {
    long before = 0, after = 0;  ///< numbers
    double share = 0;            ///< of `after`
  };
  Place place(double frame) const;
  double frame_of(long number) const;
  bool before(long a, long b) const { return source_.step > 0 ? a < b : a > b; }
  bool there(long number) const;
  std::string missing(long number) const;
  std::vector<long>::const_iterator held(long number) const;
  BaseMesh load(long number) const;
  void take_topology_of_rest(BaseMesh& mesh, long number) const;
  std::shared_ptr<const BaseMesh> read(long number) const;
  long shown(long number) const;
  std::shared_ptr<const BaseMesh> read_or_hold(long number, std::vector<std::string>* notes) const;
  std::string range_text() const;

  SequenceSource source_;
  std::unique_ptr<FrameStore> store_;
  double frames_per_number_ = 1;
  std::vector<long> numbers_;  ///< within first and last, in the order of frames
  mutable std::unique_ptr<BaseMesh> rest_;
  mutable std::map<long, std::string> faults_;  ///< of numbers that were read; empty: none
  mutable std::deque<std::pair<long, std::shared_ptr<const BaseMesh>>> kept_;  ///< the last that were read
};

}  // namespace wale
