#pragma once
#include <string>

#include "host/commands.h"

namespace wale {

struct ServeArgs : SceneArgs {
  std::string host = "127.0.0.1";
  int port = 8737;
  std::string size = "512x512";  ///< of the picture on the page at most
};

/// Edits a scene in a browser until Ctrl-C, SIGTERM or the page's stop. Prints the address, which holds the token.
int run_serve(const ServeArgs& args, const Loaders& loaders);

/// For `wale devices`: whether this build has the editor.
void print_editor_note();

}  // namespace wale
