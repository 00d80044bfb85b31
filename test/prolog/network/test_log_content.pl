:- module(test_log_content, []).
:- use_module(library(plunit)).
:- use_module('../../lib/common').
:- use_module('../../lib/networks').
:- use_module('../../lib/fixtures').
:- use_module(library(filesex)).
:- use_module(library(lists)).
:- use_module(library(typhon)).

/** <module> Logs with the content of messages

*/

%   with_pair(+Options, +Kinds, :Goal, -Events): two hosts, whose log has Kinds;
%   Goal(Hosts).

:- meta_predicate with_pair(+, +, 1, -).

with_pair(Options, Kinds, Goal, Events) :-
    with_tmp_dir(pair_in(Options, Kinds, Goal, Events)).

pair_in(Options, Kinds, Goal, Events, Dir) :-
    directory_file_path(Dir, 'events.pl', File),
    with_network(ring(2), [log(File, Kinds)|Options], _, Hosts,
        call(Goal, Hosts)),
    log_events(File, Events).

%   An agent that answers, and one that asks.

talk(Message, [First, Second]) :-
    create([ (on_message(From, X) :- send(From, got(X))) ], Answers,
           [host(Second)]),
    create([ (main :- receive(_-say(To, X)), send(To, X), receive(_)) ], Asks,
           [host(First)]),
    agent_send(Asks, say(Answers, Message)),
    agent_join(Asks, done, 10).

contents(Events, Kind, Contents) :-
    findall(Content,
            ( member(event(_, _, _, What), Events),
              What =.. [Kind, _, Content] ),
            Contents).

noted(Queue, Event) :-
    thread_send_message(Queue, Event).

%   taken(+Queue, ?Event) is nondet: all events in Queue.

taken(Queue, Event) :-
    thread_get_message(Queue, First, [timeout(0)]),
    ( Event = First ; taken(Queue, Event) ).

:- begin_tests(log_content).

%   The entries of two processes may reach the log in another order.

test(log_contains_the_content_of_messages,
     [forall(member(Options, [[clock(virtual)], [processes(2)]]))]) :-
    with_pair(Options, [messages(content)], talk(hello(X, X, "you")), Events),
    contents(Events, sent, Sent),
    assertion(permutation(Sent, [hello(Y, Y, "you"), got(hello(_, _, "you"))])),
    contents(Events, received, Received),
    assertion(permutation(Received, [say(_, _), hello(_, _, "you"), got(_)])).
test(content_is_bounded) :-
    numlist(1, 5000, Message),
    with_pair([clock(virtual)], [messages(content)], talk(Message), Events),
    contents(Events, sent, [Content|_]),
    assertion(string_length(Content, 203)),
    assertion(string_concat("[1,2,3,", _, Content)),
    assertion(string_concat(_, "...", Content)).
test(log_of_messages_alone_has_no_content, Contents == []) :-
    with_pair([clock(virtual)], [messages], talk(hello), Events),
    assertion(memberchk(event(_, _, _, sent(_)), Events)),
    contents(Events, sent, Contents).
test(watch_gets_the_content_logged_by_the_host,
     [forall(member(Kinds-Shown, [ [messages(content)]-sent(user, hello),
                                   [messages]-sent(user) ]))]) :-
    with_pair([clock(virtual)], Kinds, watched(Shown), _).

watched(Shown, [Host|_]) :-
    setup_call_cleanup(
        message_queue_create(Queue),
        ( watch(Host, test_log_content:noted(Queue), Watch),
          create([ (main :- send(user, hello)) ], Agent, [host(Host)]),
          agent_join(Agent, done, 10),
          unwatch(Watch),
          findall(What,
                  ( taken(Queue, event(_, _, Agent, What)),
                    functor(What, sent, _) ),
                  Sent)
        ),
        message_queue_destroy(Queue)),
    assertion(Sent == [Shown]).

test(unknown_kinds_are_an_error, error(type_error(_, _))) :-
    network_start(ring(2), _, [log('/dev/null', [messages(all)])]).

:- end_tests(log_content).
