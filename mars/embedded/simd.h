// The same loop compiled for several instruction sets, chosen when it runs.
#pragma once

#include "mars/embedded/block.h"

namespace mars::embedded {

#if defined(__x86_64__) && defined(__GNUC__)

// "flatten" pulls the work and what it calls into a function for the wider registers. No contraction, no
// reassociation: each lane sees the operations of the plain code.
template <class Work>
[[gnu::noinline, gnu::flatten, gnu::target("avx2")]] void run_with_avx2(const Work& work) {
  work();
}
template <class Work>
[[gnu::noinline, gnu::flatten, gnu::target("avx512f,avx512bw,avx512dq,avx512vl")]] void run_with_avx512(
    const Work& work) {
  work();
}

// Runs work(), a function object of loops over lanes, as `simd` says. All choices give equal bits.
template <class Work>
void with_simd(Simd simd, const Work& work) {
  switch (simd) {
    case Simd::kAvx512: return run_with_avx512(work);
    case Simd::kAvx2: return run_with_avx2(work);
    case Simd::kPlain: return work();
  }
}

#else

template <class Work>
void with_simd(Simd, const Work& work) {
  work();
}

#endif

}  // namespace mars::embedded
