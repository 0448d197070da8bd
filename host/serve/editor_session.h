#pragma once
#include <condition_variable>
#include <filesystem>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "host/serve/editor_messages.h"
#include "host/serve/editor_request.h"
#include "host/serve/viewer_feed.h"

namespace wale {

struct EditorOptions {
  int width = 512, height = 512;  ///< of the picture on the page at most; the scene's film is scaled into it
  size_t viewers = 8;
  std::filesystem::path kernel_dir;
};

/// A scene that is edited and rendered. Requests come from any thread and are answered at once: they change the
/// document and are checked by the schema. The thread of run() owns the device and renders the newest version: versions
/// that come faster than they can be shown are skipped. An edit that cannot be shown is taken back.
class EditorSession {
 public:
  static constexpr int kJpegQuality = 90;  ///< of 100, of the pictures in the stream

  EditorSession(EditedScene scene, const EditorOptions& options);

  /// Answers what is not the page itself.
  HttpReply handle(const EditorRequest& request);

  /// Renders until somebody asks for a stop or `stop_asked` says so. Throws device errors, and at the end a fault where
  /// samples were not finite.
  void run(std::span<const Device> device, const Loaders& loaders, const std::function<bool()>& stop_asked);
  /// Ends run() and all streams. From any thread.
  void stop();
  /// Called by a reply to stop: when it has been sent, the server may go.
  bool stopped() const;

 private:
  /// A version as run() renders it.
  struct Version {
    TriedEdits::Trial trial;
    std::vector<Scene> scenes{};  ///< one a view
    std::string fault{};          ///< why there are none
  };
  /// A picture of whole passes, and how it is shown.
  struct Shown {
    Image image;
    int shrink = 0;        ///< as RenderState's
    uint32_t samples = 0;  ///< of every pixel
    double exposure = 0;
    std::string view{};
  };

  HttpReply changed(const std::function<EditorChange()>& change);
  EditorChange control_change(const EditorRequest& request) const;
  EditorChange camera_change(const EditorRequest& request) const;
  CameraScene camera(const EditorState& state) const;
  HttpReply save(const EditorRequest& request);
  HttpReply picture(int view);
  Version next_version();
  bool another_pending() const;
  bool stopped_for_files() const;
  std::string state_json() const;
  void publish_state(bool now);
  void publish_picture(size_t view, const Version& version, Shown shown);
  void confirm(const Version& version);
  void refuse(const Version& version, const std::string& line);

  EditorOptions options_;
  ViewerFeed feed_;

  mutable std::mutex mutex_;
  std::condition_variable wake_;
  TriedEdits edits_;
  CameraScene framed_;  ///< where the scene has no camera: how it was framed
  bool stop_ = false, dirty_ = true;
  std::chrono::steady_clock::time_point last_state_{};
  std::vector<std::shared_ptr<const Shown>> shown_;
};

}  // namespace wale
