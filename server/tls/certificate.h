/* certificate.h - the certificate that the daemon shows to TLS clients; it can be replaced while
 * the daemon runs.
 *
 * One pair of a certificate and its key is in force: new handshakes use it. A handshake holds a
 * reference to its pair, so that a replacement affects neither the handshake nor its connection. A
 * pair is freed when it is not in force any more and its last reference is released. Any thread may
 * call the functions, except srv_certificates_new and srv_certificates_free. */
#ifndef HE_SERVER_TLS_CERTIFICATE_H
#define HE_SERVER_TLS_CERTIFICATE_H

#include <gnutls/abstract.h>
#include <stdbool.h>
#include <stddef.h>

enum {
    SRV_MAX_PEM = 256 * 1024, /* bytes of a file */
    /* Most certificates in a file: the server's own and its intermediates. */
    SRV_MAX_CHAIN = 16
};

/* The priority string for gnutls: it allows TLS 1.3, and of TLS 1.2 only cipher suites with forward
 * secrecy and authenticated encryption. */
extern const char srv_tls_priorities[];

typedef struct srv_certificates srv_certificates;
typedef struct srv_certificate srv_certificate;

/* Makes the object that has the pair (certificate and key) in force; it has none yet. Returns NULL
 * when memory is out. */
srv_certificates *srv_certificates_new(void);
/* Frees the object, which may be NULL. Pairs to which references are held stay until these are
 * released. */
void srv_certificates_free(srv_certificates *certificates);

/* Reads a pair from two files and puts it in force. Both files are in PEM: the first has the chain
 * of certificates, beginning with the server's own, the second has the key, not encrypted. Returns
 * false with a sentence in `message`, which names the file and the fault, if the files cannot be
 * used; the old pair then stays in force. */
bool srv_certificates_read(srv_certificates *certificates, const char *certificate_path,
                           const char *key_path, char *message, size_t size);

/* Returns a reference to the pair in force, which must exist. The caller releases it. */
srv_certificate *srv_certificates_hold(srv_certificates *certificates);
/* Releases a reference; `certificate` may be NULL. */
void srv_certificate_release(srv_certificate *certificate);

/* Sets the outputs that a callback of gnutls_certificate_set_retrieve_function3(3) must return.
 * They are borrowed from the pair, so a reference to it must be held as long as the session exists.
 */
void srv_certificate_show(srv_certificate *certificate, gnutls_pcert_st **chain,
                          unsigned int *length, gnutls_privkey_t *key);

#endif
