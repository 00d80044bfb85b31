:- module(endpoint_peer, [serve/1]).

/** <module> The other process of the endpoint tests

    swipl -g "serve(Port)" test/endpoint_peer.pl

listens to Port, prints its address, and ends when its standard input does.
Posts of kind `note` are remembered; requests are `echo`, `process` (its id),
`notes` (all notes so far), `later` (answered by another thread), `never`,
`wrong` (the hook raises), `back` (posts N notes to the asker and then
answers) and `greet(Address, N)` (the same to another, in a thread of its
own).
*/

:- use_module(common).
:- use_module(library(typhon/endpoint)).

:- dynamic note/1.

:- multifile
    typhon_endpoint:received/3,
    typhon_endpoint:requested/4.

typhon_endpoint:received(note, Note, _) :-
    assertz(note(Note)).

typhon_endpoint:requested(echo, Term, _, ReplyTo) :-
    endpoint_reply(ReplyTo, Term).
typhon_endpoint:requested(process, _, _, ReplyTo) :-
    endpoint_process(Id),
    endpoint_reply(ReplyTo, Id).
typhon_endpoint:requested(notes, _, _, ReplyTo) :-
    findall(Note, note(Note), Notes),
    endpoint_reply(ReplyTo, Notes).
typhon_endpoint:requested(later, Term, _, ReplyTo) :-
    thread_create(endpoint_reply(ReplyTo, Term), _, [detached(true)]).
typhon_endpoint:requested(never, _, _, _).
typhon_endpoint:requested(wrong, _, _, _) :-
    throw(error(type_error(right, wrong), _)).
typhon_endpoint:requested(back, N, Peer, ReplyTo) :-
    forall(between(1, N, I), endpoint_post(Peer, note, I)),
    endpoint_reply(ReplyTo, done).
typhon_endpoint:requested(greet, Address-N, _, ReplyTo) :-
    thread_create(( forall(between(1, N, I),
                           endpoint_post(Address, note, I)),
                    endpoint_reply(ReplyTo, done) ),
                  _, [detached(true)]).

serve(Port) :-
    set_prolog_flag(verbose, silent),
    endpoint_start(localhost, Port, Address),
    format("~w~n", [Address]),
    flush_output,
    read_term(user_input, _, []),
    endpoint_stop,
    halt.
