:- module(test_fake_node,
          [ node/2,                     % +Program, +Facts
            receives/2,                 % +Message, +From
            link/3,                     % +From, +Due, +Load
            at/1,                       % +Time
            sent/1,                     % -Pairs
            bodies/1,                   % -Pairs
            sends/1,                    % ?Pair
            sends_no/1,                 % ?Pair
            says/1,                     % ?Pair
            logged/1,                   % -What
            fact/1,                     % ?Fact
            job/1,                      % -Job
            offer/2,                    % +Details, -Offer
            announced/3,                % +Details, +Round, -Announcement
            failing_step/2              % :Goals, -Step
          ]).
:- use_module(fake_agent).
:- use_module(library(lists), [append/2, member/2, memberchk/2]).

/** <module> One node of an auction, alone

A simulated node: the test delivers its messages, records the messages that it
sends, and advances the time. It is at host `here` with neighbours a, b and c;
the robot of the host is agent `robot`.

*Threading*: one node at a time.
*/

%!  node(+Program, +Facts) is det.
%
%   A node of Program, `murdoch` or `anta`, with Facts; gone(Agent) marks an
%   agent that has ended.

node(Program, Facts) :-
    atomic_list_concat(['agents/allocation/', Program, '.pl'], File),
    findall(peer(Host, Node),
            member(Host-Node, [here-me, a-na, b-nb, c-nc]), Peers),
    append([Peers, [agenda(0, []), next_id(1), gone(none)], Facts], All),
    fake_agent(File, All, [robot(robot)]),
    retractall(fake_agent:tell(_, _)),
    assertz((fake_agent:tell(Agent, Message) :-
                 \+ fake_agent:gone(Agent),
                 fake_host:send(Agent, Message))),
    fake_neighbours([a, b, c]).

%!  receives(+Message, +From) is det.
%!  link(+From, +Due, +Load) is det.
%!  at(+Time) is det.
%
%   Deliver a message of an agent, or a message over the link from a host, or
%   set the time; then the node performs what is due.

receives(Message, From) :-
    once(fake_agent:heard(Message, From)),
    once(fake_agent:do_due).

link(From, Due, Load) :-
    receives(link(Due, From, Load), node).

at(Time) :-
    fake_at(Time),
    once(fake_agent:do_due).

%!  sent(-Pairs) is det.
%!  bodies(-Pairs) is det.
%
%   Messages of the node since the last call: To-Load, a host and the load of
%   the link to it, or robot-Message. With bodies/1 a flooded Load is shown as
%   its body.

sent(Pairs) :-
    findall(To-Load,
            ( retract(fake_host:did(send(Id, Message))),
              (   Message = link(_, here, Load)
              ->  fake_agent:peer(To, Id)
              ;   To = Id, Load = Message ) ),
            Pairs).

bodies(Bodies) :-
    sent(Pairs),
    findall(To-Body,
            ( member(To-Load, Pairs), load_body(Load, Body) ),
            Bodies).

load_body(flood(_, Body), Body) :- !.
load_body(only(Body), only(Body)) :- !.
load_body(Message, Message).

%!  sends(?Pair) is semidet.
%!  sends_no(?Pair) is semidet.
%!  says(?Pair) is semidet.
%
%   Pair is, or is not, one of sent/1, or is one of bodies/1.

sends(Pair) :-
    sent(Pairs),
    memberchk(Pair, Pairs).

sends_no(Pair) :-
    \+ sends(Pair).

says(Pair) :-
    bodies(Pairs),
    memberchk(Pair, Pairs).

%!  logged(-What:list) is det.
%
%   The events that the node has logged since the last call.

logged(What) :-
    findall(W, retract(fake_host:did(log(W))), What).

%!  fact(?Fact) is semidet.
%
%   Facts of the node.

fact(Fact) :-
    once(fake_agent:Fact).

%!  job(-Job) is det.
%!  offer(+Details, -Offer) is det.
%!  announced(+Details, +Round, -Announcement) is det.
%
%   A job of another host, which is for two robots that push.

offer(Details, offer(t, boss, [(1-[push])-2], Details, 10)).

job(job(owner, 1)).

announced(Details, Round, announce(Job, Round, Offer)) :-
    job(Job),
    offer(Details, Offer).

%!  failing_step(:Goals:list, -Step) is det.
%
%   Step is the first of Goals that fails, each called once, or `none`.

:- meta_predicate failing_step(:, -).

failing_step(_:[], none) :-
    !.
failing_step(M:[Goal|Goals], Step) :-
    call(M:Goal),
    !,
    failing_step(M:Goals, Step).
failing_step(_:[Step|_], Step).
