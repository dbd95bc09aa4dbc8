/* crc32c.h - the checksum of stored bytes: CRC-32C (Castagnoli), as in RFC 3720, appendix B.4. */
#ifndef HE_JOURNAL_CRC32C_H
#define HE_JOURNAL_CRC32C_H

#include <stddef.h>
#include <stdint.h>

/* Continues a checksum with `size` bytes. `before` is the checksum of all earlier bytes, 0 if there
 * are none. */
uint32_t st_crc32c(uint32_t before, const void *bytes, size_t size);
/* Computes what st_crc32c computes, but by a table, for processors without a CRC-32C
 * instruction. */
uint32_t st_crc32c_by_table(uint32_t before, const void *bytes, size_t size);

#endif
