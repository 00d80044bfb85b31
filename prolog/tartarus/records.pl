:- module(tartarus_records,
          [ record/3,                   % ?Name, ?Handler, ?Location
            record_add/4,               % +Name, +Handler, +Location, +Tokens
            record_remove/1,            % +Name
            record_life/2,              % +Name, ?Life
            record_location/2,          % +Name, -Location
            record_payload/2,           % +Name, -Indicators
            record_tokens/2,            % +Name, -Tokens
            record_static/2,            % +Name, ?Key
            set_payload/2,              % +Name, +Indicators
            set_tokens/2                % +Name, +Tokens
          ]).

/** <module> The agents of a platform, as facts

Programs look at these facts, so they are in module `user`.

*Threading*: any thread.
*/

:- dynamic                              % programs look at these
    user:agent_GUID/3,                  % Name, Handler, Location
    user:agent_payload/2,               % Name, [(Predicate,Arity), ...]
    user:agent_token/2.                 % Name, Tokens

:- dynamic
    static/2.                           % Name, Key of its port

%!  record(?Name, ?Handler, ?Location) is nondet.
%
%   The oldest first.

record(Name, Handler, Location) :-
    user:agent_GUID(Name, Handler, Location).

%!  record_add(+Name, +Handler, +Location, +Tokens) is det.
%!  record_remove(+Name) is det.

record_add(Name, Handler, Location, Tokens) :-
    set_tokens(Name, Tokens),
    set_payload(Name, []),
    assertz(user:agent_GUID(Name, Handler, Location)).

record_remove(Name) :-
    retractall(user:agent_GUID(Name, _, _)),
    retractall(user:agent_payload(Name, _)),
    retractall(user:agent_token(Name, _)),
    retractall(static(Name, _)).

%!  record_life(+Name, ?Life) is semidet.
%
%   Life stands for Name from now until it ends or moves: if it comes again,
%   that is another life.

record_life(Name, Life) :-
    clause(user:agent_GUID(Name, _, _), true, Life0),
    !,
    Life = Life0.

%!  record_location(+Name, -Location) is semidet.

record_location(Name, Location) :-
    user:agent_GUID(Name, _, Location),
    !.

%!  record_payload(+Name, -Indicators) is det.
%!  record_tokens(+Name, -Tokens) is det.
%!  set_payload(+Name, +Indicators) is det.
%!  set_tokens(+Name, +Tokens) is det.

record_payload(Name, Indicators) :-
    (   user:agent_payload(Name, Indicators0)
    ->  Indicators = Indicators0
    ;   Indicators = []
    ).

record_tokens(Name, Tokens) :-
    (   user:agent_token(Name, Tokens0)
    ->  Tokens = Tokens0
    ;   Tokens = []
    ).

set_payload(Name, Indicators) :-
    retractall(user:agent_payload(Name, _)),
    assertz(user:agent_payload(Name, Indicators)).

set_tokens(Name, Tokens) :-
    retractall(user:agent_token(Name, _)),
    assertz(user:agent_token(Name, Tokens)).

%!  record_static(+Name, ?Key) is semidet.
%
%   Name has a port of its own: note its Key, or say what it is.

record_static(Name, Key) :-
    (   nonvar(Key)
    ->  assertz(static(Name, Key))
    ;   static(Name, Key)
    ).
