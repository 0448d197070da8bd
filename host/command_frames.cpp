#include "host/command_frames.h"

#include <fmt/format.h>

#include <chrono>
#include <set>

#include "geom/error.h"
#include "geom/numbered_name.h"
#include "host/atomic_file.h"
#include "host/frame_identity.h"
#include "host/frame_range.h"
#include "host/frame_stats.h"
#include "host/image_coder.h"
#include "host/live_scene.h"
#include "host/output_names.h"
#include "host/progress.h"
#include "host/rare_events.h"
#include "host/rehearsal.h"
#include "host/sampling_report.h"
#include "host/scene_identity.h"
#include "host/stop.h"
#include "host/video.h"

namespace wale {
namespace {

using Clock = std::chrono::steady_clock;

double since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

// A frame to be shown and what is written of it.
struct Frame {
  double at = 0;
  std::vector<std::filesystem::path> files;
  bool finished = false;
};

class Frames {
 public:
  Frames(const RenderArgs& args, const Loaders& loaders)
      : args_(args), loaders_(loaders), sequences_(loaders.mesh), identity_(args, sequences_) {
    loaders_.sequence = [this](const SequenceSource& source) { return sequences_.open(source); };
    plan();
  }

  int run() {
    if (std::all_of(frames_.begin(), frames_.end(), [](const Frame& f) { return f.finished; }))
      say("all {} frames are finished", frames_.size());
    else
      render_all();
    if (!args_.stats.empty()) stats_.write(args_.stats);
    if (args_.video.empty()) return 0;
    if (stop_requested())
      say("no video: not all of its frames are there");
    else
      make_video();
    return 0;
  }

 private:
  template <typename... Args>
  void say(fmt::format_string<Args...> format, Args&&... args) const {
    if (!args_.quiet) fmt::print(stderr, "{}\n", fmt::format(format, std::forward<Args>(args)...));
  }

  std::vector<std::string> overrides(double frame) const {
    std::vector<std::string> all = overrides_of(args_);
    all.push_back(fmt::format("animation.frame={}", frame));
    return all;
  }

  Scene scene_at(double frame) const {
    Scene scene = read_scene(args_.scene, overrides(frame));
    scene.accuracy_preset = args_.preset;
    if (!args_.size.empty()) apply_size(args_.size, scene.film);
    return scene;
  }

  // Everything that can be refused is refused before the long work starts.
  void plan() {
    const Scene first = read_scene(args_);
    blurred_ = first.animation.shutter > 0;
    fps_ = first.animation.fps;
    std::vector<double> times = {first.animation.frame};
    if (!args_.frames.empty()) {
      const std::vector<long> range = frame_range(args_.frames);
      times.assign(range.begin(), range.end());
    }
    for (const auto& output : args_.outputs)
      if (times.size() > 1 && !NumberedName::is_one(output))
        user_error("{}: {} frames cannot share a name; write # for each digit of their number, for example {}_####{}",
                   output.string(), times.size(), output.stem().string(), output.extension().string());
    OutputNames names;
    for (const auto& output : {args_.stats, args_.video})
      if (!output.empty()) names.add(output);
    if (!args_.stats.empty()) require_writable_path(args_.stats);
    if (!args_.video.empty()) require_video(args_.video);
    for (const double at : times) {
      Frame frame{at, {}, false};
      for (const auto& output : args_.outputs) {
        frame.files.push_back(NumberedName::is_one(output) ? NumberedName(output).file(std::lround(at)) : output);
        names.add(frame.files.back());
        aovs_ |= is_exr(output);
      }
      frames_.push_back(std::move(frame));
    }
    for (const auto& output : frames_.front().files) require_writable(output);
    // Each frame's scene is read, and where there are pictures of it its files are hashed, which takes a while.
    Progress bar("check", args_.quiet || frames_.size() == 1);
    for (size_t i = 0; i < frames_.size(); ++i) {
      bar.update(double(i) / double(frames_.size()), fmt::format("frame {:g}", frames_[i].at));
      check(frames_[i]);
    }
    bar.finish();
  }

  // When a frame is seen: at the middle of each of equal parts of the time that the shutter is open.
  static std::vector<double> moments(const Scene& scene, int spp) {
    const double shutter = scene.animation.shutter;
    std::vector<double> at = {scene.animation.frame};
    if (shutter > 0) at.resize(size_t(std::min(scene.animation.shutter_steps, spp)), at[0]);
    for (size_t k = 0; k < at.size(); ++k) at[k] += shutter * (double(k) + 0.5) / double(at.size());
    return at;
  }

  void check(Frame& frame) {
    const Scene scene = scene_at(frame.at);
    if (scene.animation.shutter > 0 && (args_.error > 0 || args_.seconds > 0))
      user_error("--{}: a goal would not give every moment of a blurred frame its samples; valid: --spp",
                 args_.error > 0 ? "error" : "seconds");
    const std::vector<double> seen = moments(scene, most_samples(args_, scene.integrator));
    const auto require = [&](const MeshSource& mesh) {
      if (mesh.sequence)
        for (const double at : seen) sequences_.open(*mesh.sequence)->require(at);
    };
    for (const auto& fabric : scene.fabrics) require(fabric.mesh);
    for (const auto& object : scene.objects) require(object.mesh);
    for (const auto& light : scene.lights) require(light.mesh);
    if (args_.frames.empty()) return;  // one picture, always made
    size_t there = 0;
    std::string identity;
    for (const auto& file : frame.files) {
      std::error_code failed;
      if (!std::filesystem::exists(file, failed)) continue;
      if (identity.empty()) identity = identity_.of(scene, overrides(frame.at));
      if (image_text(file, kFrameAttribute) == identity) {
        ++there;
      } else if (!args_.redo) {
        user_error(
            "{}: not this frame of this scene with these settings, and not written over; move it, choose another name, "
            "or give --redo",
            file.string());
      }
    }
    frame.finished = there == frame.files.size();
  }

  void render_all() {
    const auto next = [&](size_t i) {
      while (i < frames_.size() && frames_[i].finished) ++i;
      return i;
    };
    const size_t first = next(0);
    if (first > 0) say("{} of {} frames are finished and kept", finished(), frames_.size());
    const Scene scene = scene_at(frames_[first].at);
    Rehearsal rehearsal(args_.device, [&](const DeviceTraits& traits) {
      const Features features = foresee(scene, aovs_, traits).with(args_.also);
      auto stages = geometry_stages(features);
      for (auto& stage : wavefront_stages(features)) stages.push_back(std::move(stage));
      return Rehearsal::Plan{stages, features.options(), args_.kernel_dir};
    });
    for (const unsigned number : device_numbers(args_.device)) devices_.push_back(Device::open(number));
    rehearsal.begin(devices_);
    RenderOptions options;
    options.error = args_.error;
    options.seconds = args_.seconds;
    options.aovs = aovs_;
    options.also = args_.also;
    options.kernel_dir = args_.kernel_dir;
    options.ready = catch_stop_signals;
    live_ = std::make_unique<LiveScene>(devices_, loaders_, LiveScene::Options{options, true});
    Progress bar(frames_.size() > 1 ? "frames" : "render", args_.quiet);
    for (size_t i = first; i < frames_.size() && !stop_requested(); i = next(i + 1)) {
      const auto show = [&](double part) {
        bar.update((double(i) + part) / double(frames_.size()), fmt::format("frame {:g}", frames_[i].at));
      };
      show(0);
      if (!render(frames_[i], options, show)) break;
    }
    bar.finish(stop_requested() ? "stopped" : "");
    if (!stop_requested()) rehearsal.finish();
    if (stop_requested())
      say("stopped: {} of {} frames are finished; the same command goes on from there", finished(), frames_.size());
    if (nan_) bug("render: {} samples were not finite; the pictures were written without them", nan_);
  }

  size_t finished() const {
    return size_t(std::count_if(frames_.begin(), frames_.end(), [](const Frame& f) { return f.finished; }));
  }

  // False when it was stopped.
  bool render(Frame& frame, RenderOptions options, const std::function<void(double)>& show) {
    std::string identity;  // before anything of it is read
    if (!args_.frames.empty()) identity = identity_.of(scene_at(frame.at), overrides(frame.at));
    const std::string shown = scene_identity(args_.scene, overrides(frame.at));
    const Scene scene = scene_at(frame.at);
    options.spp = most_samples(args_, scene.integrator);
    const std::vector<double> seen = moments(scene, options.spp);
    FrameStats::Row row{frame.at};
    const auto apply = [&](const Scene& version) {
      const auto start = Clock::now();
      const Redone redone = live_->apply(version);
      row.add(redone, live_->devices().front().scene->fabric(), since(start));
      note(live_->world().notes);
    };
    apply(blurred_ ? scene_at(seen[0]) : scene);
    if (stop_requested()) return false;
    options.moments = uint32_t(seen.size());
    options.at_moment = [&](uint32_t k) {
      apply(scene_at(seen[k]));
      return Moment{&live_->world(), live_->devices()};
    };
    const Rendered r = wale::render(live_->devices(), live_->world(), scene.integrator, options, [&](double f) {
      if (!args_.outputs.empty()) image_coder();
      show(f);
    });
    if (r.stopped && stop_requested()) return false;
    const auto start = Clock::now();
    if (const auto& file = identity_.changed()) {
      identity.clear();
      note({fmt::format("warning: {}: changed while frames were rendered; another run keeps none from then on",
                        file->string())});
    }
    write(frame, scene, options, r, shown, identity);
    row.write_seconds = since(start);
    row.add(r);
    stats_.rows.push_back(row);
    report(r);
    frame.finished = true;
    return true;
  }

  void write(const Frame& frame, const Scene& scene, const RenderOptions& options, const Rendered& r,
             const std::string& shown, const std::string& identity) {
    Image image = r.image;
    image.figures = sampling_attributes({options.spp, options.error, options.seconds, r.stopped, r.reached});
    image.attributes = {{kSceneAttribute, shown}, {kAccuracyAttribute, accuracy_settings(scene)}};
    if (!identity.empty()) image.attributes[kFrameAttribute] = identity;
    for (const auto& file : frame.files) write_image(image, file, scene.film.exposure, scene.film.view);
  }

  void note(const std::vector<std::string>& notes) {
    for (const auto& text : notes)
      if (noted_.insert(text).second) say("note: {}", text);
  }

  void report(const Rendered& r) {
    for (const RareEvent& e : kRareEvents)
      if (r.counts.events[e.counter] && e.weight == RareEvent::Weight::warning)
        note({fmt::format("warning: {}: in this frame {} times", e.name, r.counts.events[e.counter])});
    nan_ += r.counts.events[W_EVENT_NAN];
  }

  void make_video() {
    const auto& files = frames_.front().files;
    const auto exr = std::find_if(files.begin(), files.end(), [](const auto& f) { return is_exr(f); });
    const size_t which = exr == files.end() ? 0 : size_t(exr - files.begin());
    Progress bar("video", args_.quiet);
    write_video(args_.video, fps_, frames_.size(), [&](size_t k) {
      bar.update(double(k) / double(frames_.size()));
      const FilmScene film = scene_at(frames_[k].at).film;
      const Image image = read_image(frames_[k].files[which]);
      const bool display = !is_exr(frames_[k].files[which]);
      return VideoFrame{image.width, image.height,
                        display_bytes(image, display ? 0 : film.exposure, display ? "srgb" : film.view)};
    });
    bar.finish();
  }

  const RenderArgs& args_;
  Loaders loaders_;
  OpenSequences sequences_;
  FrameIdentity identity_;
  std::vector<Frame> frames_;
  bool aovs_ = false, blurred_ = false;
  double fps_ = 24;
  std::vector<Device> devices_;
  std::unique_ptr<LiveScene> live_;
  std::set<std::string> noted_;
  uint64_t nan_ = 0;
  FrameStats stats_;
};

}  // namespace

int run_frames(const RenderArgs& args, const Loaders& loaders) { return Frames(args, loaders).run(); }

}  // namespace wale
