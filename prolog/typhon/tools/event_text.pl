:- module(typhon_event_text,
          [ happening/3,                % +What, //
            own_event/1,                % +What
            short_name/2                % +Name, -Short
          ]).

/** <module> What happens to agents, in words

*Threading*: pure.
*/

:- use_module('../kernel/base/error_text', [term_told/3]).

%!  happening(+What, -Text, ?Rest) is det.
%
%   The text of an event, see typhon_events, as a message: what an agent did,
%   or what happened to it.

happening(What) -->
    { \+ own_event(What) },
    !,
    [ 'logs ' ],
    term_told(What).
happening(created) --> [ 'begins' ].
happening(ended(Outcome)) --> [ 'ends, ' ], term_told(Outcome).
happening(faulty(Error)) --> [ 'is faulty: ' ], term_told(Error).
happening(fault(fault(Error, Goal, Place, _))) -->
    [ 'is faulty, ' ],
    term_told(Error),
    [ ': ' ],
    term_told(Goal),
    [ ', at ~w'-[Place] ].
happening(link(To)) --> named('is linked with ~w', To).
happening(unlink(To)) --> named('is not linked with ~w any more', To).
happening(started) --> [ 'starts' ].
happening(stopped) --> [ 'stops' ].
happening(refused(Agent, Reason)) -->
    named('refuses ~w', Agent),
    [ ': ' ],
    term_told(Reason).
happening(left(To)) --> named('leaves for ~w', To).
happening(stayed(To)) --> named('could not go to ~w', To).
happening(arrived(From, Seconds)) -->
    named('comes from ~w', From),
    [ ', in ~4g s'-[Seconds] ].
happening(cloned(Clone)) --> named('has a clone, ~w', Clone).
happening(sent(To)) --> named('sends to ~w', To).
happening(sent(To, Message)) -->
    [ 'sends ' ],
    term_told(Message),
    named(' to ~w', To).
happening(received(From)) --> named('takes a message from ~w', From).
happening(received(From, Message)) -->
    [ 'takes ' ],
    term_told(Message),
    named(' from ~w', From).
happening(leave(Fact)) --> [ 'leaves ' ], term_told(Fact), [ ' here' ].
happening(take(Fact)) --> [ 'takes ' ], term_told(Fact), [ ' up here' ].
happening(goal(Goal)) -->
    { copy_term(Goal, Shown, _),
      numbervars(Shown, 0, _, [singletons(true)])
    },
    [ '~W'-[ Shown, [ quoted(true), portray(false), numbervars(true),
                      max_depth(10), spacing(next_argument) ] ] ].
%!  own_event(+What) is semidet.
%
%   What is of the platform.  Agents may log whatever they like; what looks
%   like this all the same is taken for it.

own_event(created).
own_event(ended(_)).
own_event(faulty(_)).
own_event(fault(fault(_, _, _, _))).
own_event(link(To)) :- is_name(To).
own_event(unlink(To)) :- is_name(To).
own_event(started).
own_event(stopped).
own_event(refused(Agent, _)) :- atom(Agent).
own_event(left(To)) :- is_name(To).
own_event(stayed(To)) :- is_name(To).
own_event(arrived(From, Seconds)) :- atom(From), number(Seconds).
own_event(cloned(Id)) :- is_name(Id).
own_event(sent(To)) :- atom(To).
own_event(sent(To, _)) :- atom(To).
own_event(received(From)) :- atom(From).
own_event(received(From, _)) :- atom(From).
own_event(leave(_)).
own_event(take(_)).
own_event(goal(_)).

is_name(Name) :-
    atom(Name),
    sub_atom(Name, _, _, _, @),
    !.

named(Format, Name) -->
    { short_name(Name, Short) },
    [ Format-[Short] ].

%!  short_name(+Name, -Short) is det.
%
%   What stands before the address in the name of an agent or a host.

short_name(Name, Short) :-
    atom(Name),
    sub_atom(Name, Before, _, _, @),
    !,
    sub_atom(Name, 0, Before, _, Short).
short_name(Name, Name).
