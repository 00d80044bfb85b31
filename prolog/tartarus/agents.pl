:- module(tartarus_agents,
          [ create_mobile_agent/2,      % ?Name, +Handler
            create_mobile_agent/3,      % ?Name, +LocationOrHandler, +X
            create_mobile_agent/4,      % ?Name, ?Location, +Handler, +Tokens
            create_static_agent/3,      % ?Name, ?Location, +Handler
            create_static_agent/4,      % ?Name, ?Location, +Handler, +Tokens
            agent_create/2,             % ?Name, +Handler
            agent_create/3,             % ?Name, ?Location, +Handler
            execute_agent/3,            % +Name, +Location, +Handler
            execute_agent/4,            % +Name, +Location, +Handler, +Start
            agent_execute/4,            % +Name, +Location, +Handler, +Start
            purge_agent/1,              % +Name
            add_token/2,                % +Name, +Tokens
            remove_token/2,             % +Name, +Tokens
            add_payload/2,              % +Name, +Indicators
            remove_payload/2,           % +Name, +Indicators
            list_agent/0,
            list_agent/1,               % -Agents
            agent_list_new/1,           % -Names
            isexist_agent/3,            % ?Name, ?Location, ?Handler
            get_new_name/2,             % +Base, -Name
            get_new_name_alpha/1        % -Name
          ]).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(gensym), [gensym/2]).
:- use_module(library(lists), [member/2, reverse/2, subtract/3, union/3]).
:- use_module(library(random), [random_member/2]).
:- use_module('../typhon', [remote/2]).
:- use_module(clauses, [body_copy/2, body_erase/2, body_has/2]).
:- use_module(lives,
              [ life_begin/4, life_end/1, record/3, record_payload/2,
                record_static/2, record_tokens/2, run_handler/4,
                set_payload/2, set_tokens/2 ]).
:- use_module(platform,
              [ here/1, location_address/2, must/1, port_open/2,
                same_location/2, print_lines/2, verbosely/2, print_problem/2 ]).

/** <module> Agents of a platform

Creating, running and ending agents, and their tokens and payloads.

*Threading*: any thread.
*/

                /*******************************
                *            CREATE            *
                *******************************/

%!  create_mobile_agent(?Name, ?Location, +Handler, +Tokens) is det.
%!  create_mobile_agent(?Name, +Handler, +Tokens) is det.
%!  create_mobile_agent(?Name, ?Location, +Handler) is det.
%!  create_mobile_agent(?Name, +Handler) is det.
%!  agent_create(?Name, ?Location, +Handler) is det.
%!  agent_create(?Name, +Handler) is det.
%
%   Create an agent, which does not run yet.  An unbound Name is bound to six
%   letters; unbound parts of Location are those of this platform.  An agent of
%   that name on this platform is replaced.

create_mobile_agent(Name, Handler, Tokens) :-
    atom(Handler),
    !,
    create_mobile_agent(Name, _, Handler, Tokens).
create_mobile_agent(Name, Location, Handler) :-
    agent_create(Name, Location, Handler).

create_mobile_agent(Name, Location, Handler, Tokens) :-
    named(Name),
    must([ check(ma1, 'the name is an atom', atom(Name)),
           check(ma2, 'the handler is an atom', atom(Handler)),
           check(ma3, 'the tokens are a list, and not empty',
                 Tokens = [_|_]),
           check(ma4, 'the tokens are integers', integers(Tokens)) ]),
    located(Location),
    must([check(ma5, 'Handler not present',
                present(Location, Handler))]),
    create(Location, Name, Handler, Tokens).

create_mobile_agent(Name, Handler) :-
    agent_create(Name, _, Handler).

agent_create(Name, Handler) :-
    agent_create(Name, _, Handler).

agent_create(Name, Location, Handler) :-
    named(Name),
    must([ check(ma1, 'the name is an atom', atom(Name)),
           check(ma2, 'the handler is an atom', atom(Handler)) ]),
    located(Location),
    create(Location, Name, Handler, []).

named(Name) :-
    (   var(Name)
    ->  get_new_name_alpha(Name)
    ;   true
    ).

integers(Tokens) :-
    is_list(Tokens),
    maplist(integer, Tokens).

located(Location) :-
    (   ground(Location)
    ->  true
    ;   \+ here(_)
    ->  must([check(ma6, 'a platform has been started', fail)])
    ;   here(Here),
        completed(Location, Here)
    ->  true
    ;   must([check(ma7, 'the location is (IP,Port)', fail)])
    ).

%   An address may be written in two ways, as localhost and 127.0.0.1.

completed(Location, Location) :-
    !.
completed((Ip,Port), (Here,Port)) :-
    nonvar(Ip),
    same_location((Ip,Port), (Here,Port)).

%   Another platform checks its handlers itself.

present(Location, Handler) :-
    (   is_here(Location)
    ->  body_has(guid, (Handler,3))
    ;   true
    ).

is_here(Location) :-
    here(Here),
    same_location(Here, Location).

create(Location, Name, Handler, Tokens) :-
    is_here(Location),
    !,
    create_here(Name, Handler, Tokens).
create((Ip,Port), Name, Handler, Tokens) :-
    print_lines("Creating agent on platform with IP ~w and port number ~w~n",
                [Ip, Port]),
    location_address((Ip,Port), Address),
    catch(remote(Address,
                 tartarus_agents:create_for_other(Name, Handler, Tokens)),
          error(Formal, _),
          ( print_problem('Agent ~w cannot be created at ~w, port ~w: ~p',
                          [Name, Ip, Port, Formal]),
            fail )).

create_for_other(Name, Handler, Tokens) :-
    body_has(guid, (Handler,3)),
    create_here(Name, Handler, Tokens).

create_here(Name, Handler, Tokens) :-
    here(Location),
    life_begin(Name, Location, Handler, Tokens),
    verbosely("Agent with name ~w created~n", [Name]).

%!  create_static_agent(?Name, ?Location, +Handler, +Tokens) is semidet.
%!  create_static_agent(?Name, ?Location, +Handler) is semidet.
%
%   Create an agent that stays, with a port of its own in this process.

create_static_agent(Name, Location, Handler) :-
    static_agent(Name, Location, Handler, []).

create_static_agent(Name, Location, Handler, Tokens) :-
    must([ check(sa3, 'the tokens are a list, and not empty',
                 Tokens = [_|_]),
           check(sa4, 'the tokens are integers', integers(Tokens)) ]),
    static_agent(Name, Location, Handler, Tokens).

static_agent(Name, Location, Handler, Tokens) :-
    named(Name),
    must([ check(sa1, 'the name is an atom', atom(Name)),
           check(sa2, 'the handler is an atom', atom(Handler)),
           check(sa5, 'the location is (IP,Port)',
                 ( nonvar(Location), Location = (_,Port), integer(Port) )),
           check(sa6, 'Handler not present',
                 ( atom(Handler), body_has(guid, (Handler,3)) )) ]),
    Location = (_,Port),
    life_end(Name),
    catch(port_open(Port, Key), error(Formal, _),
          ( print_problem('Port ~w cannot be opened: ~p', [Port, Formal]),
            fail )),
    life_begin(Name, Location, Handler, Tokens),
    record_static(Name, Key),
    verbosely("Agent with name ~w created~n", [Name]).

%!  execute_agent(+Name, +Location, +Handler) is det.
%!  execute_agent(+Name, +Location, +Handler, +Start) is det.
%!  agent_execute(+Name, +Location, +Handler, +Start) is det.
%
%   Run Handler of Name in a thread of its own, from `main` or Start.  Errors
%   and failure of the handler are not reported.

execute_agent(Name, Location, Handler) :-
    agent_execute(Name, Location, Handler, main).

execute_agent(Name, Location, Handler, Start) :-
    must([check(ea8, 'where to start is an atom', atom(Start))]),
    agent_execute(Name, Location, Handler, Start).

agent_execute(Name, Location, Handler, Start) :-
    (   record(Name, Handler, Own),
        same_location(Own, Location)
    ->  run_handler(Name, Handler, Start, in_turn)
    ;   print_problem('There is no agent ~w with handler ~w at ~w here',
                      [Name, Handler, Location])
    ).

%!  purge_agent(+Name) is det.
%
%   End an agent.  Its threads run to their end.

purge_agent(Name) :-
    life_end(Name).

:- multifile tartarus_platform:closing/0.

tartarus_platform:closing :-
    findall(Name, record(Name, _, _), Names),
    maplist(purge_agent, Names).

                /*******************************
                *       TOKENS, PAYLOAD        *
                *******************************/

%!  add_token(+Name, +Tokens) is semidet.
%!  remove_token(+Name, +Tokens) is semidet.

add_token(Name, Tokens) :-
    known(Name),
    record_tokens(Name, Old),
    union(Old, Tokens, New),
    set_tokens(Name, New).

remove_token(Name, Tokens) :-
    known(Name),
    record_tokens(Name, Old),
    subtract(Old, Tokens, New),
    set_tokens(Name, New).

known(Name) :-
    (   record(Name, _, _)
    ->  true
    ;   print_problem('There is no agent ~w here', [Name]),
        fail
    ).

%!  add_payload(+Name, +Indicators) is semidet.
%
%   Copy the clauses of each predicate, (Name,Arity), about `guid` for the
%   agent.  From then on it travels with all clauses of the predicate about it.

add_payload(Name, Indicators) :-
    known(Name),
    record_payload(Name, Old),
    subtract(Indicators, Old, New),
    union(Old, New, Payload),
    set_payload(Name, Payload),
    forall(member(Indicator, New), body_copy(Name, Indicator)).

%!  remove_payload(+Name, +Indicators) is semidet.

remove_payload(Name, Indicators) :-
    known(Name),
    record_payload(Name, Old),
    subtract(Indicators, Old, Unknown),
    subtract(Indicators, Unknown, Known),
    body_erase(Name, Known),
    (   Unknown == []
    ->  subtract(Old, Known, New),
        set_payload(Name, New)
    ;   print_problem('Agent ~w has no payload ~w', [Name, Unknown])
    ).

                /*******************************
                *             LISTS            *
                *******************************/

%!  list_agent is det.
%!  list_agent(-Agents:list) is det.
%!  agent_list_new(-Names:list) is det.
%
%   List the agents of this platform.  As in Tartarus, list_agent/0 and
%   agent_list_new/1 begin with the oldest, and list_agent/1, whose elements are
%   (Name,Handler,Port), with the newest.

list_agent :-
    print_lines("================Agent list===============~n", []),
    forall(record(Name, Handler, (_,Port)),
           print_lines("Agent Name :~w, handler name:~w, residing on port:~w~n",
                       [Name, Handler, Port])),
    print_lines("=========================================~n", []).

list_agent(Agents) :-
    findall((Name,Handler,Port), record(Name, Handler, (_,Port)), Oldest),
    reverse(Oldest, Agents).

agent_list_new(Names) :-
    findall(Name, record(Name, _, _), Names).

tartarus_platform:status :-
    print_lines("Agent_GUID:~n", []),
    forall(record(Name, Handler, Location),
           print_lines("~w|~w|~w~n", [Name, Handler, Location])),
    print_lines("Agent_payload:~n", []),
    forall(( record(Name, _, _), record_payload(Name, Payload) ),
           print_lines("~w|~w~n", [Name, Payload])),
    print_lines("Agent_token:~n", []),
    forall(( record(Name, _, _), record_tokens(Name, Tokens) ),
           print_lines("~w|~w~n", [Name, Tokens])).

:- multifile tartarus_platform:status/0.

%!  isexist_agent(?Name, ?Location, ?Handler) is semidet.
%
%   True of the oldest agent of this platform that matches.

isexist_agent(Name, Location, Handler) :-
    record(Name, Handler, Own),
    (   var(Location)
    ->  Location = Own
    ;   matches(Location, Own)
    ),
    !.

matches(Location, Location) :-
    !.
matches(Location, Own) :-
    ground(Location),
    same_location(Location, Own).

%!  get_new_name(+Base, -Name) is det.
%!  get_new_name_alpha(-Name) is det.
%
%   Name is not the name of an agent of this platform: it is Base with a number
%   and the place, or six letters.

get_new_name(Base, Name) :-
    gensym(Base, Numbered),
    (   here((Ip,Port))
    ->  atomic_list_concat([Numbered,Ip,Port], '_', Name)
    ;   Name = Numbered
    ).

get_new_name_alpha(Name) :-
    length(Letters, 6),
    maplist(letter, Letters),
    atom_chars(Name0, Letters),
    (   record(Name0, _, _)
    ->  get_new_name_alpha(Name)
    ;   Name = Name0
    ).

letter(Letter) :-
    random_member(Letter, [a,b,c,d,e,f,g,h,i,j,k,l,m,n,o,p,q,r,s,t,u,v,w,x,
                           y,z]).
