#include "server/tls/tls_record.h"

ssize_t srv_tls_receive(gnutls_session_t session, void *buffer, size_t size)
{
    unsigned char sequence[8];
    return gnutls_record_recv_seq(session, buffer, size, sequence);
}

bool srv_tls_send(gnutls_session_t session, const char *bytes, size_t length)
{
    while (length > 0) {
        ssize_t sent = gnutls_record_send(session, bytes, length);
        if (sent <= 0) {
            return false;
        }
        bytes += sent;
        length -= (size_t)sent;
    }
    return true;
}
