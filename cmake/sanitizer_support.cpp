// What programs built with a sanitizer link besides: suppressions by the name of a library, and libraries that stay
// loaded, so that reports can name them.
#include <dlfcn.h>

#ifdef VPE_THREAD_SANITIZER
#include <cstddef>
#include <new>

// Refuse arrays that no machine has, as without a sanitizer: ThreadSanitizer ends the program with a report, where readers of
// damaged files catch std::bad_alloc.
void* operator new[](std::size_t bytes) {
  constexpr std::size_t kMost = std::size_t{1} << 39;
  if (bytes > kMost) throw std::bad_alloc();
  return ::operator new(bytes);
}
void operator delete[](void* memory) noexcept { ::operator delete(memory); }
void operator delete[](void* memory, std::size_t /*bytes*/) noexcept { ::operator delete(memory); }
#endif

extern "C" {

// Replaces that of the C library. A graphics driver is unloaded with its display; what it leaves behind would be
// reported as of an unknown module.
int dlclose(void* /*handle*/) { return 0; }

// Return the status of a program with a report. The default, 1, is also that of the program's own errors, so
// that a test which expects an error would pass. ThreadSanitizer ends with 66 anyway.
const char* __asan_default_options() { return "exitcode=66"; }
const char* __ubsan_default_options() { return "exitcode=66"; }

// Returns what LeakSanitizer leaves out: memory that drivers and text libraries keep until the end. None of
// them calls the program's own code, whose leaks would be left out with theirs.
const char* __lsan_default_suppressions() {
  return "leak:_dri.so\nleak:libgallium\nleak:libEGL\nleak:libGLX\nleak:libGLdispatch\nleak:libOSMesa\nleak:libLLVM\n"
         "leak:libfontconfig\nleak:libX11\nleak:libspnav\n";
}

// Returns options of LeakSanitizer. Its use_tls stays on: libgdal and the loader hold memory by pointers in
// thread-local memory, which would be reported.
const char* __lsan_default_options() { return "print_suppressions=0"; }

// Returns what ThreadSanitizer leaves out: accesses by libraries that are not instrumented, and the order in which
// they take their own locks. Two accesses of the program's own code are reported whoever calls it. One of them and
// one of a library, in memory that the library was given, are not.
const char* __tsan_default_suppressions() {
  return "race:_dri.so\nrace:libgallium\nrace:libEGL\nrace:libOSMesa\nrace:libLLVM\nrace:libfontconfig\n"
         "race:libgdal\nrace:libproj\nrace:libsqlite3\nrace:libcurl\nrace:libcairo\nrace:libpango\n"
         "race:libopenvdb\nrace:libtbb\n"
         "deadlock:_dri.so\ndeadlock:libgallium\ndeadlock:libEGL\ndeadlock:libgdal\n";
}

}  // extern "C"
