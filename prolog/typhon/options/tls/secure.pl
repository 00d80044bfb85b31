:- module(typhon_secure, []).

/** <module> TLS connections between processes

If the endpoint has keys, a connection begins with a TLS 1.3 handshake, and both
sides send a certificate.  It must be signed by the authority of the directory,
valid for hosts, not expired and not revoked.  TLS encrypts the rest of the
connection, including the cookie.

A directory holds `cert.pem` and `key.pem` of this process, `ca.pem` of the
authority, and `crl.pem`, its revocations.  They are read for each connection,
so a revocation takes effect with the next connection.

OpenSSL lets one thread read while another one writes only after the session
tickets of the handshake have arrived.  They arrive with the first line of the
server, which is read before any thread writes frames.

*Threading*: the caller serialises begin and end; a handshake runs in the thread
of its connection.  The connection manager limits its duration.
*/

:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(error),
              [existence_error/2, permission_error/3, syntax_error/1]).
:- use_module(library(lists), [member/2]).
:- use_module(library(option), [option/2]).
:- use_module(library(settings), [setting/2]).
:- use_module('../../kernel/base/monotonic', [deadline/2]).
:- use_module('../../kernel/wire',
              [ line_read/3, line_write/2, manager_notify/1,
                transport_octets/1 ]).
:- use_module('../keys',
              [ key_loaded/3, keys_certificate/2, keys_file/3, keys_holder/3,
                own_keys/1, own_keys_begin/1, own_keys_end/0 ]).

:- autoload(library(ssl),
            [ certificate_field/2, ssl_context/3, ssl_negotiate/5,
              ssl_peer_certificate/2 ]).

:- multifile
    typhon_connection:harmless/1,
    typhon_on_demand:joins/2,
    typhon_options:declared/4,
    typhon_transport:begins/4,
    typhon_transport:ends/1,
    typhon_transport:disagrees/1,
    typhon_transport:opens/7,
    typhon_transport:closes/0.

typhon_options:declared(host_option, tls(Directory), text, Directory).

%   A guest, a process without hosts, gets the option from the environment.

typhon_on_demand:joins(environment, 'TYPHON_TLS').

typhon_transport:begins(Options, tls, Own, certificate(unknown)) :-
    (   option(tls(Directory), Options)
    ->  true
    ;   getenv('TYPHON_TLS', Directory),
        Directory \== ''
    ),
    begin(Directory, Own).

%   begin(+Directory, -Own): all connections begun after this use TLS, with the
%   keys in Directory.
%
%   @error existence_error(file, File)
%   @error ssl_error(Code, Library, Function, Reason)

begin(Directory0, Own) :-
    absolute_file_name(Directory0, Directory),
    forall(member(Which, [cert, key, ca, crl]),
           must_be_there(Directory, Which)),
    context(server, Directory, _),
    keys_certificate(Directory, Certificate),
    (   keys_holder(Directory, Certificate, host(Name))
    ->  Own = certificate(Name)
    ;   Own = cookie                    % peers will reject this certificate
    ),
    own_keys_begin(Directory).

typhon_transport:ends(tls) :-
    own_keys_end.

typhon_transport:disagrees(tls(Directory0)) :-
    absolute_file_name(Directory0, Directory),
    \+ own_keys(Directory).

must_be_there(Directory, Which) :-
    keys_file(Directory, Which, File),
    (   exists_file(File)
    ->  true
    ;   existence_error(file, File)
    ).

context(Role, Directory, Context) :-
    maplist(keys_file(Directory), [cert, key, ca],
            [Certificate, Key, Authority]),
    revoked(Directory, Revoked),
    ssl_context(Role, Context,
                [ certificate_file(Certificate),
                  key_file(Key),
                  cacerts([file(Authority)]),
                  peer_cert(true),
                  min_protocol_version(tlsv1_3),
                  close_parent(true),
                  cert_verify_hook(typhon_secure:verified)
                | Revoked
                ]).

%   Library(ssl) never frees a revocation list, about 4 kB for each connection,
%   so an empty one is left out.  A context cannot be shared by connections: it
%   would mix up their peers.

revoked(Directory, Options) :-
    key_loaded(Directory, crl, List),
    (   memberchk(revocations([]), List)
    ->  Options = []
    ;   keys_file(Directory, crl, File),
        Options = [crl([File]), require_crl(true)]
    ).

%   verified(+SSL, +Certificate, +Chain, +First, +Verdict): succeeds only for
%   the verdict `verified`; records the reason of another verdict for the error.

:- public verified/5.

verified(_, _, _, _, verified) :-
    !.
verified(_, _, Chain, _, Verdict) :-
    verdict(Verdict, Chain, Why),
    nb_setval(typhon_verdict, Why),
    fail.

verdict(self_signed_cert, [_], Why) =>
    Why = self_made.
verdict(self_signed_cert, _, Why) =>
    Why = foreign.
verdict(unknown_issuer, _, Why) =>
    Why = foreign.
verdict(issuer_cert_unavailable, _, Why) =>
    Why = foreign.
verdict(bad_certificate_use, _, Why) =>
    Why = wrong_use.
verdict(Verdict, _, Why) =>
    Why = Verdict.

                 /*******************************
                 *          HANDSHAKE           *
                 *******************************/

%   The proof of the peer is certificate(Name).
%
%   @error permission_error(authenticate, peer, tls(Why)) Why is `expired` or
%   `revoked`; `foreign`: another authority has signed the certificate of the
%   peer; `self_made`: the certificate is self-signed; `wrong_use`: it is no
%   certificate of a host; his(What): the peer rejects the certificate of this
%   process; `plain`: the peer does not use TLS; or a reason given by OpenSSL
%   @error syntax_error(end_of_file)
%   @error timeout_error(read, tls) the handshake took too long

typhon_transport:opens(tls, Role, In, Out, SIn, SOut, certificate(Name)) :-
    own_keys(Directory),
    catch(in_time(handshake(Role, Directory, In, Out, SIn, SOut, Name)),
          error(ssl_error(_, _, _, Reason), _),
          refuse(Reason)).

handshake(Role, Directory, In, Out, SIn, SOut, Name) :-
    nb_setval(typhon_verdict, none),
    context(Role, Directory, Context),
    nb_setval(typhon_secure, under(In, Out)),
    ssl_negotiate(Context, In, Out, SIn, SOut),
    nb_setval(typhon_secure, over(SIn, SOut)),
    maplist(transport_octets, [SIn, SOut]),
    peer_name(SIn, Name),
    welcome(Role, SIn, SOut).

%   A client finishes the handshake before the server has checked its
%   certificate.  So the client sends nothing until the server accepts the
%   certificate or reports why it does not.

welcome(server, _, SOut) :-
    line_write(SOut, "typhon tls").
welcome(client, SIn, _) :-
    setting(typhon_handshake:handshake_time, Seconds),
    deadline(Seconds, Deadline),
    line_read(SIn, Deadline, Line),
    (   Line == "typhon tls"
    ->  true
    ;   permission_error(authenticate, peer, protocol)
    ).

peer_name(SIn, Name) :-
    ssl_peer_certificate(SIn, Certificate),
    certificate_field(Certificate, subject(Subject)),
    memberchk('CN'=Name, Subject).

%   A timeout of the stream is not enough: a peer that sends a byte now and then
%   would never cause it.

:- meta_predicate in_time(0).
:- public too_late/0.

in_time(Goal) :-
    setting(typhon_handshake:handshake_time, Seconds),
    thread_self(Me),
    deadline(Seconds, Time),
    ignore(manager_notify(later(Time, typhon_secure:late(Me)))),
    setup_call_cleanup(
        nb_setval(typhon_shaking, true),
        catch(Goal, Ball, in_time_or_not(Ball)),
        nb_setval(typhon_shaking, false)).

%   On 10.1.12 an exception inside OpenSSL is reported as the end of the file.

in_time_or_not(_) :-
    nb_current(typhon_shaking, late),
    !,
    throw(error(timeout_error(read, tls), _)).
in_time_or_not(Ball) :-
    throw(Ball).

late(Thread) :-
    catch(thread_signal(Thread, typhon_secure:too_late),
          error(existence_error(_, _), _),
          true).

too_late :-
    (   nb_current(typhon_shaking, true)
    ->  nb_setval(typhon_shaking, late),
        throw(error(timeout_error(read, tls), _))
    ;   true
    ).

%   refuse(+Reason): raise the error of Typhon for the reason of OpenSSL.

refuse(_) :-
    nb_current(typhon_verdict, Verdict),
    Verdict \== none,
    !,
    permission_error(authenticate, peer, tls(Verdict)).
refuse('unexpected eof while reading') :-
    !,
    syntax_error(end_of_file).
refuse('wrong version number') :-
    !,
    permission_error(authenticate, peer, tls(plain)).
refuse(Reason) :-
    alert(Reason, Why),
    !,
    permission_error(authenticate, peer, tls(his(Why))).
refuse(Reason) :-
    permission_error(authenticate, peer, tls(Reason)).

%   alert(+Reason, -Why): the peer rejects the certificate of this process.

alert(Reason, Why) :-
    said(Part, Why),
    sub_atom(Reason, _, _, 0, Part),
    !.

said('alert certificate expired', expired).
said('alert certificate revoked', revoked).
said('alert unknown ca', foreign).
said('alert unsupported certificate', wrong_use).
said('alert certificate required', no_certificate).
said('alert bad certificate', bad_certificate).
said('alert certificate unknown', bad_certificate).
said('alert protocol version', version).

typhon_transport:closes :-
    nb_current(typhon_secure, Streams),
    opened(Streams, All),
    maplist(close_stream, All).

opened(over(SIn, SOut), [SOut, SIn]).
opened(under(In, Out), Streams) :-
    findall(Stream, above(In, Out, Stream), Streams).

%   above(+In, +Out, -Stream): ssl_negotiate/5 has created Stream.  A thread
%   that is interrupted at that point has no reference to these streams, and the
%   connection closes only when they are closed.

above(In, Out, Stream) :-
    member(Mode, [append, write, read]),
    stream_property(In, file_no(Number)),
    stream_property(Stream, file_no(Number)),
    stream_property(Stream, mode(Mode)),
    Stream \== In,
    Stream \== Out.

close_stream(Stream) :-
    catch(close(Stream, [force(true)]), error(_, _), true).

%   These errors occur when the peer has closed the connection.

typhon_connection:harmless(ssl_error(_, _, _, 'unexpected eof while reading')).
typhon_connection:harmless(ssl_error(_, _, _, 'tlsv1 alert decode error')).
