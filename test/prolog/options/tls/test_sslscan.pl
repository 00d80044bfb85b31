:- module(test_sslscan, []).

% The findings of an auditor's tool about an endpoint with keys.

:- use_module('../../../lib/common').
:- use_module('../../../lib/authority').
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(plunit)).
:- use_module(library(process), [process_create/3, process_wait/2]).
:- use_module(library(typhon)).

:- needs([sslscan]).

scanned(Lines) :-
    with_authority([alpha], [], scanned(Lines)).

scanned(Lines, Authority) :-
    directory_file_path(Authority, alpha, Dir),
    setup_call_cleanup(
        host_start(alpha, [tls(Dir)]),
        ( host_property(alpha, address(Address)),
          atomic_list_concat([_, Endpoint], @, Address),
          sslscan(Endpoint, Lines) ),
        host_stop(alpha)).

sslscan(Endpoint, Lines) :-
    setup_call_cleanup(
        process_create(path(sslscan), ['--no-colour', Endpoint],
                       [stdout(pipe(Out)), stderr(null), process(Pid)]),
        read_string(Out, _, Text),
        ( close(Out), process_wait(Pid, _) )),
    split_string(Text, "\n", " \t", Lines).

has_line(Lines, Prefix) :-
    member(Line, Lines),
    string_concat(Prefix, _, Line),
    !.

:- begin_tests(sslscan).

test(scanner_finds_no_weakness) :-
    scanned(Lines),
    forall(member(Good, [ "TLSv1.3   enabled", "TLSv1.2   disabled",
                          "TLSv1.1   disabled", "TLSv1.0   disabled",
                          "SSLv3     disabled", "SSLv2     disabled" ]),
           assertion(has_line(Lines, Good))),
    forall(( member(Line, Lines),
             member(Part, ["vulnerable to", "Anonymous", "NULL", "MD5"]),
             sub_string(Line, _, _, _, Part) ),
           assertion(sub_string(Line, _, _, _, "not vulnerable"))),
    forall(( member(Line, Lines),
             member(Start, ["Preferred ", "Accepted "]),
             string_concat(Start, _, Line) ),
           assertion(sub_string(Line, _, _, _, " TLSv1.3 "))).

:- end_tests(sslscan).
