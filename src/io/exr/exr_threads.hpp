// The threads on which OpenEXR decodes.
#pragma once

namespace spectile::io {

/// Gives OpenEXR that many threads, fewer where the system makes no more; without any, the caller decodes.
/// Throws: std::bad_alloc.
void set_exr_threads(int threads);

}  // namespace spectile::io
