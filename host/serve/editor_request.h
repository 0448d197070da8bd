#pragma once
#include <optional>
#include <string>
#include <vector>

#include "host/json_document.h"
#include "host/serve/http_server.h"

namespace wale {

/// Who may ask, and how.
struct EditorGate {
  std::string token;
  std::string host = "127.0.0.1";  ///< that is listened on
};

/// True where a Host header names this machine as the editor is reached: a loopback name on any port (it may have been
/// forwarded), and where the editor listens elsewhere too, that host or an address in digits. A name that somebody else
/// resolves to this machine (DNS rebinding) is none of them.
bool host_allowed(const EditorGate& gate, std::string_view host_header);

/// What a request asks for.
struct EditorRequest {
  enum class Kind { page, stream, state, edit, control, camera, undo, redo, reset, save, picture, stop } kind;
  std::vector<std::string> set{};  ///< edit: overrides as `--set` takes them
  std::string control{};           ///< id of the control that asks; errors are told beside it
  JsonNode value{};                ///< control: what it is set to
  std::string gesture{};           ///< edits of one gesture are one step of undo
  double orbit[2] = {0, 0};        ///< camera: radians to the right and up
  double pan[2] = {0, 0};          ///< camera: picture heights to the right and up
  double zoom = 1;                 ///< camera: factor on the distance
  std::string file{};              ///< save: name in the scene's folder
  bool replace = false;            ///< save: a file of that name may be replaced
  int view = 0;                    ///< picture: number of the view
};

/// A request, or the reply that refuses it.
struct ReadRequest {
  std::optional<EditorRequest> request;
  HttpReply refusal;
};

/// Everything that can be refused by the head alone: who asks (404 for unknown paths, 405, 403 for Host and Origin, 401
/// for the token), and what kind of body comes (411, 413, 415). Nothing when it may go on.
std::optional<HttpReply> refuse_request(const EditorGate& gate, const HttpRequest& request, size_t longest_body);

/// Reads a request that was not refused, with its body: strict JSON, no unknown keys. 400 with one line otherwise.
ReadRequest read_editor_request(const HttpRequest& request);

/// {"error": line} with a status.
HttpReply refusal(int status, const std::string& line);

}  // namespace wale
