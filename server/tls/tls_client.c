#include "server/tls/tls_client.h"

#include "server/tls/tls_record.h"

/* Returns true if a call that returned this code must be repeated. A timeout of the socket, which
 * gnutls reports as GNUTLS_E_AGAIN, ends the exchange. */
static bool goes_on(ssize_t code)
{
    return code == GNUTLS_E_INTERRUPTED ||
           (code < 0 && code != GNUTLS_E_AGAIN && gnutls_error_is_fatal((int)code) == 0);
}

static bool shake_hands(gnutls_session_t session)
{
    int code;
    do {
        code = gnutls_handshake(session);
    } while (goes_on(code));
    return code == GNUTLS_E_SUCCESS;
}

static size_t exchange(gnutls_session_t session, const char *request, size_t length, char *answer,
                       size_t size)
{
    size_t got = 0;
    ssize_t code;
    if (!shake_hands(session)) {
        return 0;
    }
    do {
        code = gnutls_record_send(session, request, length);
    } while (goes_on(code));
    /* A request shorter than a TLS record is sent as a whole or not at all. */
    while (code > 0 && got < size) {
        do {
            code = srv_tls_receive(session, answer + got, size - got);
        } while (goes_on(code));
        got += code > 0 ? (size_t)code : 0;
    }
    return got;
}

size_t srv_tls_ask(int socket, const char *request, size_t length, char *answer, size_t size)
{
    gnutls_session_t session = NULL;
    gnutls_certificate_credentials_t none = NULL;
    size_t got = 0;
    if (gnutls_init(&session, GNUTLS_CLIENT | GNUTLS_NO_SIGNAL) >= 0 &&
        gnutls_set_default_priority(session) >= 0 &&
        gnutls_certificate_allocate_credentials(&none) >= 0 &&
        gnutls_credentials_set(session, GNUTLS_CRD_CERTIFICATE, none) >= 0) {
        gnutls_transport_set_int(session, socket);
        got = exchange(session, request, length, answer, size);
    }
    if (session != NULL) {
        gnutls_deinit(session);
    }
    if (none != NULL) {
        gnutls_certificate_free_credentials(none);
    }
    return got;
}
