// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: functions compiled for several instruction sets.

#ifndef tanktread_base_target_clones_h
#define tanktread_base_target_clones_h

/**
 * Before a function: compiled for AVX-512, AVX2 and the baseline (TANKTREAD_CLONES) or for the latter two (TANKTREAD_CLONES_AVX2, for code in vectors of four
 * doubles); the best that the processor has is chosen when the program starts. Not for templates. Older compilers do not know the names of the sets, and the
 * address sanitizer is not ready when the choice is made.
 */
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && __GNUC__ >= 12 && !defined(__SANITIZE_ADDRESS__)
#  define TANKTREAD_CLONES __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#  define TANKTREAD_CLONES_AVX2 __attribute__((target_clones("arch=x86-64-v3", "default")))
#else
#  define TANKTREAD_CLONES
#  define TANKTREAD_CLONES_AVX2
#endif

#endif
