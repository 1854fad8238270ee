// Text files that appear whole or not at all.
#include <spectile/output_file.hpp>

#include "src/base/atomic_file.hpp"
#include "src/base/errors.hpp"

namespace spectile {

Result<void> check_writable(const std::string& path) {
  SPECTILE_ASSIGN(const auto file, io::AtomicFile::create(path));
  return {};
}

Result<void> write_text_file(const std::string& path, std::string_view text) {
  SPECTILE_ASSIGN(auto file, io::AtomicFile::create(path));
  SPECTILE_TRY(file.write_at(text.data(), text.size(), 0));
  return file.commit(false);
}

}  // namespace spectile
