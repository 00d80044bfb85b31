:- module(typhon_quotas,
          [ quota/3,                    % ?Host, ?What, -Most
            quota_shared/4,             % ?Host, ?Whose, ?What, -Most
            quota_any/1                 % ?Host
          ]).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(error), [domain_error/2, must_be/2]).
:- use_module(library(lists), [member/2]).
:- use_module(library(option), [option/3]).
:- use_module('../base/error_text', [print_error/2]).
:- use_module('../base/own_thread', [in_own_thread/1]).
:- use_module(hosts, [host_option/2]).

/** <module> How much agents may use on a host

Quotas are What(Most), of each agent that stands on the host:

  - inferences(N), seconds(S): between two stops
  - stack(Bytes), state(Bytes)
  - cells(N): parts of what it sends, logs, leaves or gives as its result
  - clones(N): agents of its program and owner that are here when it clones,
    and clones made of these in a second
  - payloads(N): that it carries when it attaches one
  - tuples(N): facts that it has left in the tuple space
  - mailbox(N): messages that wait for it
  - lifetime(S): by the clock of the host, from when it came here
  - messages(N), log(N), facts(N), hops(N): sent, logged, left and begun in a
    second

and owner(What(Most)) of all agents here that have one owner, see
typhon_owner, together, and host(What(Most)) of all that are here.  There are
also owner(agents(N)), how many may be here, and host(tuples(N)), the facts in
the tuple space.  The largest user ends first: of what the host has together, the
agents of the owner that uses most of it.

A host that guards has the defaults, where it is not said otherwise.  A host
without quotas does without all of this: looking whether there are some is all
that it costs.

While there are hosts with quotas of what is not counted when it is used, a
thread checks ten times a second how much each uses.

*Threading*: any thread.
*/

:- multifile
    typhon_host_parts:begins/3,
    typhon_host_parts:changeable/1,
    typhon_host_parts:changes/2,
    typhon_host_parts:ends/1,
    typhon_names:known/2,       % Kind, Name
    set/1,                      % Host has other quotas now
    look/0,                     % agents that use too much are interrupted
    forgotten/1.                % Host has no quotas any more

:- dynamic
    quota/3,                    % Host, What, Most
    quota_shared/4,             % Host, Whose: owner or host, What, Most
    quota_any/1,                % Host: it has some of them
    watching/1,                 % Thread
    set/1,
    look/0,
    forgotten/1.

%   quota_default(?Quota): where strangers are let in.

quota_default(seconds(5)).
quota_default(stack(67 108 864)).
quota_default(state(16 777 216)).
quota_default(cells(200 000)).
quota_default(clones(100)).
quota_default(payloads(100)).
quota_default(tuples(10 000)).
quota_default(mailbox(10 000)).
quota_default(messages(10 000)).
quota_default(facts(10 000)).
quota_default(hops(10 000)).
quota_default(log(1000)).
quota_default(host(tuples(100 000))).

%   kind(?What, -Whose): of whom there are such quotas.  Those that are
%   `watched` the thread looks after.

kind(inferences, [agent]).
kind(cells,      [agent]).
kind(payloads,   [agent]).
kind(mailbox,    [agent]).
kind(lifetime,   [agent]).
kind(agents,     [owner]).
kind(clones,     [agent, owner, host]).
kind(tuples,     [agent, owner, host]).
kind(messages,   [agent, owner, host]).
kind(log,        [agent, owner, host]).
kind(facts,      [agent, owner, host]).
kind(hops,       [agent, owner, host]).
kind(state,      [agent, owner, host]).
kind(seconds,    [agent, owner, host]).
kind(stack,      [agent, owner, host]).

typhon_names:known(quota, Name) :-
    kind(Name, _).

%   The quotas of a host follow from its options policy and quota.
%
%   @error domain_error(quota, Quota), type_error(number, Most)

typhon_host_parts:begins(Host, _, Options) :-
    option(policy(Policy), Options, trusted),
    option(quota(Quotas), Options, []),
    quota_set(Host, Policy, Quotas).

typhon_host_parts:changeable(quota(_)).

typhon_host_parts:changes(policy(Policy), Host) :-
    ( host_option(Host, quota(Quotas)) -> true ; Quotas = [] ),
    quota_set(Host, Policy, Quotas).
typhon_host_parts:changes(quota(Quotas), Host) :-
    ( host_option(Host, policy(Policy)) -> true ; Policy = trusted ),
    quota_set(Host, Policy, Quotas).

typhon_host_parts:ends(Host) :-
    quota_forget(Host).

quota_set(Host, Policy, Quotas) :-
    maplist(must_be_quota, Quotas),
    findall(quota(Whose, What, Most),
            in_force(Policy, Quotas, Whose, What, Most), All),
    retractall(quota(Host, _, _)),
    retractall(quota_shared(Host, _, _, _)),
    forall(member(Quota, All), add(Quota, Host)),
    (   All == []
    ->  retractall(quota_any(Host))
    ;   quota_any(Host)
    ->  true
    ;   assertz(quota_any(Host))
    ),
    forall(set(Host), true),
    watch.

add(quota(agent, What, Most), Host) :-
    !,
    assertz(quota(Host, What, Most)).
add(quota(Whose, What, Most), Host) :-
    assertz(quota_shared(Host, Whose, What, Most)).

must_be_quota(Quota) :-
    (   parts(Quota, Whose, What, Most),
        kind(What, All),
        memberchk(Whose, All)
    ->  must_be(number, Most),
        ( Most > 0 -> true ; domain_error(quota, Quota) )
    ;   domain_error(quota, Quota)
    ).

%   parts(+Quota, -Whose, -What, -Most)

parts(Quota, Whose, What, Most) :-
    compound(Quota),
    compound_name_arguments(Quota, Name, [Arg]),
    (   memberchk(Name, [owner, host]),
        compound(Arg)
    ->  Whose = Name,
        compound_name_arguments(Arg, What, [Most])
    ;   Whose = agent,
        What = Name,
        Most = Arg
    ).

in_force(_, Quotas, Whose, What, Most) :-
    member(Quota, Quotas),
    parts(Quota, Whose, What, Most).
in_force(Policy, Quotas, Whose, What, Most) :-
    Policy \== trusted,
    quota_default(Default),
    parts(Default, Whose, What, Most),
    \+ ( member(Given, Quotas), parts(Given, Whose, What, _) ).

%!  quota(?Host, ?What, -Most) is nondet.
%!  quota_shared(?Host, ?Whose, ?What, -Most) is nondet.
%
%   A host of this process has a quota, of each agent; of what agents of one
%   owner, or all agents, have together.

%!  quota_any(?Host) is nondet.
%
%   A host of this process has quotas: where none has, this is all that is
%   asked.

quota_forget(Host) :-
    retractall(quota(Host, _, _)),
    retractall(quota_shared(Host, _, _, _)),
    retractall(quota_any(Host)),
    watch,
    forall(forgotten(Host), true).

                /*******************************
                *           THE WATCH          *
                *******************************/

watch :-
    to_be_watched,
    !,
    (   watching(_)
    ->  true
    ;   thread_create(typhon_quotas:watch_on, Thread,
                      [alias(typhon_quota_watch)]),
        assertz(watching(Thread))
    ).
watch :-
    (   retract(watching(Thread))
    ->  thread_send_message(Thread, stop),
        in_own_thread(thread_join(Thread, _))
    ;   true
    ).

to_be_watched :-
    quota(_, seconds, _).
to_be_watched :-
    quota(_, stack, _).
to_be_watched :-
    member(What, [seconds, stack, state]),
    quota_shared(_, _, What, _).

:- public watch_on/0.

watch_on :-
    thread_self(Me),
    (   thread_get_message(Me, stop, [timeout(0.1)])
    ->  true
    ;   catch(forall(look, true), error(Formal, Context),
              print_error(error, error(Formal, Context))),
        watch_on
    ).
