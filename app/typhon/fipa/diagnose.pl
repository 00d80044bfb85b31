:- module(typhon_diagnose_fipa,
          [ diagnose_fipa/1             % +Url
          ]).

/** <module> Diagnosis of an unreachable FIPA platform

Tests the steps from the URL of the platform to an accepted message.

*Threading*: the calling thread.
*/

:- use_module(library(socket), [tcp_connect/3]).
:- use_module('../../../prolog/typhon/bridges/fipa/acl', [acl_text/2]).
:- use_module('../../../prolog/typhon/bridges/fipa/http',
              [http_post/4, http_response/3, http_url/3]).
:- use_module('../../../prolog/typhon/bridges/fipa/letter', [letter_write/5]).
:- use_module('../diagnose', [diagnose_steps/2]).

deadline(5).                            % seconds without an answer

%!  diagnose_fipa(+Url) is semidet.
%
%   Prints the result of each step to the message transport at Url.  Fails at
%   the first step that does not work.

diagnose_fipa(Url) :-
    findall(Step-Advice, step(Step, Advice), Steps),
    diagnose_steps(Steps, check(Url)).

step(url, 'It begins with http://, and has a port and a path: \c
           http://127.0.0.1:7778/acc. TLS is not supported.').
step(connection, 'Does the platform run, and listen on an interface that \c
                  can be reached from here?').
step(message, 'Another program listens there, or it accepts no messages. JADE \c
               on Java 17 has to be started with --add-exports, see \c
               doc/bridges-fipa.md.').

check(Url, url, Found) :-
    http_url(Url, Address, Path),
    format(atom(Found), '~w, path ~w', [Address, Path]).
check(Url, connection, Found) :-
    connected(Url, _, _, true),
    Found = 'a program listens there'.
check(Url, message, Found) :-
    To = fipa('ams@platform', [Url]),
    From = fipa(diagnosed, []),
    acl_text(acl(inform, [ sender(From), receiver([To]),
                           content("anybody there?") ]), Text),
    letter_write(Text, From, To, Type, Body),
    connected(Url, In, Out,
              ( http_post(Out, Url, Type, Body),
                http_response(In, Code, _) )),
    (   Code == 200
    ->  Found = 'it takes messages'
    ;   throw(error(domain_error(fipa_response, Code), _))
    ).

:- meta_predicate connected(+, -, -, 0).

connected(Url, In, Out, Goal) :-
    http_url(Url, Address, _),
    deadline(Seconds),
    setup_call_cleanup(
        tcp_connect(Address, Stream, []),
        ( stream_pair(Stream, In, Out),
          set_stream(In, timeout(Seconds)),
          set_stream(Stream, encoding(octet)),
          once(Goal) ),
        close(Stream, [force(true)])).
