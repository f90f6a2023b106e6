/// \file multi_version.h
/// Hot loops compiled for more than one instruction set, of which the processor's best is taken at run time.
#pragma once

#include <cstddef>  // tells which C library it is

// Sanitizers can't look into a choice that the loader makes before they are set up.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define PCL_FLOAM_SANITIZED
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define PCL_FLOAM_SANITIZED
#endif
#endif

/// Before a function: a version for AVX2 beside the plain one. Without fused multiplications, so that both give the
/// same bits. GCC with glibc, whose loader makes the choice.
#if defined(__x86_64__) && defined(__GLIBC__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(PCL_FLOAM_SANITIZED)
#define PCL_FLOAM_MULTI_VERSION __attribute__((target_clones("default", "avx2")))
#else
#define PCL_FLOAM_MULTI_VERSION
#endif
