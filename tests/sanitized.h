/* sanitized.h - sizes of tests under a sanitizer.
 *
 * AddressSanitizer and ThreadSanitizer make a program three to twenty times slower. They judge each
 * access to memory, and a loop that is already warm makes the same accesses again. So a test that
 * counts its rounds in hundreds may do fewer of them under a sanitizer, as long as every path is
 * still taken; the plain build, in which the results count, does all of them. */
#ifndef TESTS_SANITIZED_H
#define TESTS_SANITIZED_H

#if defined(__SANITIZE_THREAD__) || defined(__SANITIZE_ADDRESS__)
enum { SANITIZED = 1 };
#else
enum { SANITIZED = 0 };
#endif

#endif
