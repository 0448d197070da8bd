// The editor's page in headless Chromium: tests/host/serve_page.py says what it looks at.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "host/serve/http_server.h"
#include "tests/temporary_folder.h"

namespace wale {
namespace {

TEST(ServePage, EveryControlChangesThePictureAsItSays) {
  const char* all = std::getenv("WALE_LONG_TESTS");
  if (!all || std::string(all) != "1") GTEST_SKIP() << "long: ./wale test --long";
  if (!has_http_library()) GTEST_SKIP() << "built without cpp-httplib";
  const std::filesystem::path source = WALE_SOURCE_DIR;
  TemporaryFolder folder;
  std::filesystem::copy_file(source / "scenes/swatch_front.json", folder / "scene.json");
  const std::string log = (folder / "log.txt").string();
  const int status = std::system(("timeout 900 python3 " + (source / "tests/host/serve_page.py").string() + " " +
                                  WALE_PROGRAM + " " + (folder / "scene.json").string() + " >" + log + " 2>&1")
                                     .c_str());
  if (WEXITSTATUS(status) == 77) GTEST_SKIP() << "Chromium is not installed (apt-get install chromium)";
  EXPECT_EQ(status, 0) << file_text(log);
}

}  // namespace
}  // namespace wale
