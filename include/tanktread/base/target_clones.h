// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: functions compiled for several instruction sets.

#ifndef tanktread_base_target_clones_h
#define tanktread_base_target_clones_h

/** Before a function: compiled for AVX-512, AVX2 and the baseline, the best of which is chosen when the program starts. Not for templates. */
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#  define TANKTREAD_CLONES __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#  define TANKTREAD_CLONES
#endif

#endif
