// Handover: tells ThreadSanitizer that work passes from thread to thread by ways it cannot see.
#pragma once

#if defined(SPECTILE_TSAN)
extern "C" void __tsan_acquire(void* address);
extern "C" void __tsan_release(void* address);
#endif

namespace spectile::tiles {

/// States that everything before give() happens before everything after a later take() of the same Handover,
/// as oneTBB sees to, whose library ThreadSanitizer does not look into. Orders nothing itself; empty in other
/// builds.
class Handover {
 public:
  void give() noexcept {
#if defined(SPECTILE_TSAN)
    __tsan_release(this);
#endif
  }
  void take() noexcept {
#if defined(SPECTILE_TSAN)
    __tsan_acquire(this);
#endif
  }
};

/// Gives when it goes out of scope, also by an exception.
class GiveAtEnd {
 public:
  explicit GiveAtEnd(Handover& handover) noexcept : handover_(handover) {}
  ~GiveAtEnd() { handover_.give(); }
  GiveAtEnd(const GiveAtEnd&) = delete;
  GiveAtEnd& operator=(const GiveAtEnd&) = delete;

 private:
  Handover& handover_;
};

}  // namespace spectile::tiles
