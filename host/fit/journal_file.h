#pragma once
#include <filesystem>
#include <optional>
#include <string>

#include "host/fit/fit.h"

namespace wale::fit {

/// Writes what a fit knows, and what it is a fit of: scene, photographs and settings.
void write_journal(const FitJournal& journal, const std::string& identity, const std::filesystem::path& file);

/// The journal in a file; nothing where there is no file. Throws a user error where it is of another fit or damaged.
std::optional<FitJournal> read_journal(const std::filesystem::path& file, const std::string& identity, size_t axes);

}  // namespace wale::fit
