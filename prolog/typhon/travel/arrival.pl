:- module(typhon_arrival, []).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(lists), [append/3]).
:- use_module('../journal',
              [crash_point/1, journal_on/0, journal_seal/0, journal_step/1]).
:- use_module('../program', [code_module/2, code_receive/2]).
:- use_module('../wire',
              [ endpoint_afterwards/1, endpoint_reply/2, endpoint_reply_later/2 ]).
:- use_module('../host',
              [ audit/3, event/4, guarding/0, host/3, host_enter/4, host_hop/3,
                host_leave/1, host_time/2, peer_may/3, quota_any/1, schedule/2,
                schedule_adopt/2, schedule_here/2, schedule_leave/0 ]).
:- use_module('../agent',
              [ agent/5, agent_order/2, agent_status/3, birth_proved/4,
                birth_sent/2, image_enter/4, image_entered/3, image_label/2,
                image_module/3, image_newcomer/3, image_payloads/2,
                image_trail/4, life_hops/2, quota_against/3,
                policy_against/4, policy_refuses/2, with_agent/2 ]).
:- use_module(crossings,
              [ crossing_done/1, crossing_end/2, crossing_known/1,
                is_crossing/1 ]).
:- use_module(home, [agent_outcome/2]).
:- use_module(post, [post_waiting/2]).
:- use_module(transfer, [transfer_let_go/4]).
:- use_module(whereabouts, [agent_heard_of/2, agent_seen/4]).

/** <module> Agents arrive

The other half of a hop, see typhon_hop: install what comes, whole or not at
all, and answer.  A transfer that comes again is recognised by what is known
anyhow: the agent stands here, has gone on, or has ended.

*Threading*: the reader threads of the endpoint.
*/

:- multifile
    typhon_endpoint:lent/2,
    typhon_endpoint:requested/4,
    typhon_endpoint:returned/0.

typhon_endpoint:requested(hop, hop(Name, Image, Program), Peer, ReplyTo) :-
    arrived(Name, Image, Program, none, Peer, ReplyTo).
typhon_endpoint:requested(hop, hop(Name, Image, Program, Label), Peer,
                          ReplyTo) :-
    (   is_crossing(Label)
    ->  arrived(Name, Image, Program, Label, Peer, ReplyTo)
    ;   endpoint_reply(ReplyTo, refused(error(type_error(crossing, Name))))
    ).

arrived(Name, Image, Program, Label, Peer, ReplyTo) :-
    catch(arrive_noted(Name, Image, Program, Label, Peer, Answer),
          error(Formal, Context),
          ( print_message(error, error(Formal, Context)),
            Answer = refused(error(Formal))
          )),
    answer(Answer, Name, ReplyTo).

arrive_noted(Name, Image, Program, Label, Peer, Answer) :-
    (   journal_on
    ->  journal_step(arrive(Name, Image, Program, Label, Peer, Answer)),
        crash_point(before_answer)
    ;   arrive(Name, Image, Program, Label, Peer, Answer)
    ).

%   The agent must not run before the answer is on its way: what it sends
%   comes behind it.

answer(installed(Id), Name, ReplyTo) :-
    !,
    endpoint_reply_later(ReplyTo, accepted),
    endpoint_afterwards(go_on(Name, Id)).
answer(Answer, _, ReplyTo) :-
    endpoint_reply(ReplyTo, Answer).

%   go_on(+Name, +Id, +Where): `here`, in this thread, or `later`.

go_on(Name, Id, here) :-
    schedule_here(Name, Id).
go_on(Name, Id, later) :-
    schedule(Name, Id).

typhon_endpoint:lent(_:go_on(_, Id), Thread) :-
    schedule_adopt(Thread, Id).

typhon_endpoint:returned :-
    schedule_leave.

arrive(Name, Image, Papers, Crossing, Peer, Answer) :-
    birth_sent(Papers, Program),
    image_label(Image, Label),
    (   has_come(Crossing, Label)
    ->  Answer = accepted
    ;   turned_away(Name, Label, Image, Papers-Program, Peer, Answer)
    ->  true
    ;   Label = label(_, _, Hash, Tokens, _, _),
        host_enter(Name, Hash, Tokens, Entered),
        entered(Entered, Program, Name, Label, Image, Crossing-Peer, Answer)
    ).

has_come(Crossing, _) :-
    Crossing \== none,
    crossing_known(Crossing),
    !.
has_come(_, label(Id, Hops, _, _, _, _)) :-
    repeated(Id, Hops).

%   turned_away(+Name, +Label, +Image, +Sent, +Peer, -Answer): before any room
%   is taken on the host; the first reason counts.

turned_away(Name, _, _, _, Peer, refused(peer)) :-
    \+ peer_may(Peer, Name, agents),
    !.
turned_away(Name, label(Id, _, Hash, _, _, _), _, Papers-_, Peer, Answer) :-
    \+ birth_proved(Papers, Peer, Id, Hash),
    !,
    unproved(Papers, Name, Id, Peer, Answer).
turned_away(Name, label(Id, _, Hash, _, _, _), Image, _-Program, Peer,
            refused(Reason)) :-
    unfit(Name, Hash, Image, Program, Peer, Reason),
    !,
    audit(Name, Peer, refused(Id, Reason)).
turned_away(_, label(_, _, Hash, _, _, _), _, _-Program, _, need_program) :-
    \+ has_code(Hash, Program),
    !.
turned_away(Name, _, Image, _, _, refused(unsigned)) :-
    \+ image_payloads(Image, Name).

unfit(Name, Hash, _, Program, _, Reason) :-
    guarding,
    host(Name, _, Place),
    policy_against(Place, Hash, Program, Reason),
    !.
unfit(Name, _, Image, _, Peer, Reason) :-
    quota_any(Name),
    image_newcomer(Peer, Image, Newcomer),
    quota_against(Name, Newcomer, Reason).

%   He may have the signature.

entered(refused(unsigned), known, _, _, _, _, need_program) :-
    !.
entered(Entered, _, Name, Label, Image, From, Answer) :-
    admitted(Entered, Name, Label, Image, From, Answer).

%   He may have what proves it.

unproved(Papers, _, _, _, need_program) :-
    \+ subsumes_term(papers(_, _), Papers),
    !.
unproved(_, Name, Id, Peer, refused(identity)) :-
    audit(Name, Peer, refused(Id, identity)).

repeated(Id, Hops) :-
    (   agent(Id, _, _, _, Life)
    ->  life_hops(Life, Hops0),
        Hops0 >= Hops
    ;   agent_outcome(Id, _)
    ->  true
    ;   agent_heard_of(Id, Hops0),
        Hops0 >= Hops
    ).

%   @error domain_error(program_of_hash(Hash), Program)

has_code(Hash, Program) :-
    (   Program == known
    ->  code_module(Hash, _)
    ;   code_receive(Hash, Program)
    ).

admitted(refused(Reason), _, _, _, _, refused(Reason)).
admitted(ok, Name, Label, Image, Crossing-Peer, Answer) :-
    catch(install(Name, Label, Image, Crossing-Peer, Installed), Ball,
          ( host_leave(Name), not_installed(Ball, Installed) )),
    installed(Installed, Name, Label, Peer, Answer).

%   The host was stopped, or the program thrown out, since we looked; or
%   there are two agents of this id, one of which was taken for dead: the
%   one that is here stays.

installed(in(Address, Gone), Name, Label, Peer, installed(Id)) :-
    Label = label(Id, _, _, _, _, _),
    call(Gone),
    report_arrival(Name, Address, Label, Peer).
installed(refused(Reason), _, _, _, refused(Reason)).
installed(repeated, Name, _, _, accepted) :-
    host_leave(Name).
installed(unknown_host, Name, _, _, refused(unknown_host)) :-
    host_leave(Name).
installed(need_program, Name, _, _, need_program) :-
    host_leave(Name).

not_installed(Ball, Installed) :-
    (   policy_refuses(Ball, Reason)
    ->  Installed = refused(Reason)
    ;   throw(Ball)
    ).

%   install(+Name, +Label, +Image, -Installed): all or nothing.

install(Name, Label, Image0, Crossing-Peer, Installed) :-
    (   host(Name, Address, Place)
    ->  Label = label(Id, Hops, _, _, _, _),
        image_trail(received(Address), Name, Image0, Image1),
        image_entered(Peer, Image1, Image),
        with_agent(Id, ( install(Id, Hops, Image, Crossing, Name-Address,
                                 Place, Installed),
                         ( journal_on -> journal_seal ; true ) ))
    ;   Installed = unknown_host
    ).

%   All is noted, and sealed, before anybody can find it here.

install(Id, Hops, Image, Crossing, Name-Address, Place, Installed) :-
    (   overtaken(Id, Hops)
    ->  Installed = repeated
    ;   image_module(Image, Place, Module)
    ->  let_go(Id, Later, Orders, Gone),
        post_waiting(Id, Last),
        append(Later, Last, More),
        (   Crossing == none
        ->  true
        ;   crossing_done(Crossing)
        ),
        image_enter(Image, Name, Module, More),
        maplist(agent_order(Id), Orders),
        Installed = in(Address, Gone)
    ;   Installed = need_program
    ).

overtaken(Id, Hops) :-
    repeated(Id, Hops),
    !.
overtaken(Id, _) :-
    agent_status(Id, Status, _),
    Status \= transit(_, _).

%   Our own copy, still waiting for the answer, is out of date.

let_go(Id, Mail, Orders, Gone) :-
    (   transfer_let_go(Id, Mail0, Orders0, Gone0)
    ->  crossing_end(Id, _),
        Mail = Mail0,
        Orders = Orders0,
        Gone = Gone0
    ;   Mail = [],
        Orders = [],
        Gone = true
    ).

report_arrival(Name, Address, label(Id, Hops, _, _, Since, From), Peer) :-
    debug(typhon(hop), '~w hop ~D: is on ~w, from ~w',
          [Id, Hops, Address, Peer]),
    agent_seen(Id, Address, Hops, Peer),
    (   host_time(Name, Now)
    ->  Seconds is max(0.0, Now-Since),
        host_hop(Name, in, Seconds),
        came_from(From, Peer, Where),
        event(hops, Name, Id, arrived(Where, Seconds))
    ;   true                            % the host is being stopped
    ).

%   Where nobody wanted to know when it left, only the process is known.

came_from(none, Peer, Peer) :-
    !.
came_from(From, _, From).
