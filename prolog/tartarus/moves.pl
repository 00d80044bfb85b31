:- module(tartarus_moves,
          [ move_agent/2,               % +Name, +Location
            clone_agent/3,              % +Name, +Location, -Clone
            land/1,                     % +Bundle
            in_hop_time/2,              % ?Agent, ?Seconds
            out_hop_time/2,             % ?Agent, ?Seconds
            in_hop_time/5,              % ?Agent, ?From, ?To, ?Date, ?Seconds
            out_hop_time/5,             % ?Agent, ?From, ?To, ?Date, ?Seconds
            in_hop_time_stat/3,         % -Max, -Min, -Mean
            out_hop_time_stat/3,        % -Max, -Min, -Mean
            overall_hop_time_stat/3,    % -Max, -Min, -Mean
            in_hop_times_info/1,        % -List
            out_hop_times_info/1,       % -List
            in_hop_times_details/1,     % -List
            out_hop_times_details/1,    % -List
            hoptime/4                   % ?Agent, ?From, ?To, ?Seconds
          ]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(gensym), [gensym/2]).
:- use_module('../typhon', [agent_create/3, agent_join/3]).
:- use_module(clauses, [body/3, renamed/4]).
:- use_module(lives,
              [ life_begin/6, life_elsewhere/2, record/3, record_life/2,
                record_payload/2, record_static/2, record_tokens/2,
                run_handler/4 ]).
:- use_module(platform,
              [ here/1, location_address/2, must/1, print_lines/2,
                print_problem/2, same_location/2, verbosely/2, verbosity/1 ]).

/** <module> Moves of agents between platforms, and their times

The parts of an agent travel as a bundle, which a carrier, an agent of Typhon,
takes to the other platform and installs there.  So the bundle arrives once or
not at all, whatever happens to the connection; the agent is removed here only
after the bundle has arrived.

The sender measures a hop from sending to the acknowledgement of the arrival;
the receiver from sending to arrival, by the clocks of both.

*Threading*: move_agent/2 and clone_agent/3 return when the agent has been
admitted or refused; carriers call land/1, in a worker; any thread may read the
times.
*/

:- dynamic turned_back/2.               % Carrier, Why

%!  move_agent(+Name, +Location) is det.
%
%   Move an agent to another platform, where its handler runs from `main`.  The
%   goals that follow run here.  If the move fails, the reason is printed and
%   the agent stays.

move_agent(Name, Location) :-
    must([ check(mov1, 'the agent is an atom', atom(Name)),
           check(mov2, 'the port is an integer',
                 ( nonvar(Location), Location = (_,Port), integer(Port) )) ]),
    move(Name, Location).

move(Name, _) :-
    (   \+ record(Name, _, _)
    ;   record_static(Name, _)
    ),
    !,
    print_lines("Move agent Failed for :~w~n", [Name]).
move(_, Location) :-
    here(Here),
    same_location(Here, Location),
    !,
    print_lines("Agent is already on same platform.~n", []),
    abort.
move(Name, Location) :-
    record_life(Name, Life),
    bundle(Name, Bundle),
    sent(Bundle, Location, Outcome),
    moved(Outcome, Name, Life).

moved(landed, Name, Life) :-
    life_elsewhere(Name, Life).
moved(stays, _, _).

%!  clone_agent(+Name, +Location, -Clone) is semidet.
%
%   Send a copy to Location, which may be this platform, where it runs from
%   `main`; the original continues.  Clone is Name with a number.

clone_agent(Name, Location, Clone) :-
    must([ check(clo1, 'the port is an integer',
                 ( nonvar(Location), Location = (_,Port), integer(Port) )) ]),
    (   record(Name, _, _)
    ->  gensym(Name, Clone),
        bundle(Name, Bundle0),
        renamed(Name, Clone, Bundle0, Bundle),
        sent(Bundle, Location, _)
    ;   print_problem('There is no agent ~w to be cloned', [Name]),
        fail
    ).

%   bundle(+Name, -Bundle): bundle(Name, Handler, Payload, Clauses, Tokens,
%   From, Time).

bundle(Name, bundle(Name, Handler, Payload, Clauses, Tokens, Here, Time)) :-
    record(Name, Handler, _),
    !,
    record_payload(Name, Payload),
    record_tokens(Name, Tokens),
    body(Name, [(Handler,3)|Payload], Clauses),
    here(Here),
    get_time(Time).

%   sent(+Bundle, +Location, -Outcome): Outcome is `landed` or `stays`.

sent(Bundle, Location, Outcome) :-
    carried(Location, Bundle, Result),
    get_time(Now),
    Bundle = bundle(Name, _, _, _, _, Here, Time),
    Seconds is Now-Time,
    say(Result, Name, Location),
    (   Result == landed
    ->  hop_done(out, Name, Here, Location, Seconds),
        verbosely("Time taken to get acknowledgement by agent ~w:~w~n",
                  [Name, Seconds]),
        Outcome = landed
    ;   Outcome = stays
    ).

say(landed, _, _).
say(refused, Name, _) :-
    print_lines("--------negative ACK received-----------~n", []),
    print_lines("Agent ~w was not allowed to enter the destination.~n", [Name]),
    print_lines("--------negative ack processed-----------~n", []).
say(missed(Formal), Name, (Ip,Port)) :-
    print_problem('Agent ~w cannot go to ~w, port ~w: ~p',
                  [Name, Ip, Port, Formal]),
    print_lines("Enter a valid IP address and Port number.~n", []).

                /*******************************
                *            CARRIERS          *
                *******************************/

%   carried(+Location, +Bundle, -Result): Result is `landed`, `refused` or
%   missed(Formal).

carried(Location, Bundle, Result) :-
    here(Here),
    same_location(Here, Location),
    !,
    arg(5, Bundle, Tokens),
    (   user:platform_token(Token),
        memberchk(Token, Tokens)
    ->  land(Bundle),
        Result = landed
    ;   Result = refused
    ).
carried(Location, Bundle, Result) :-
    location_address(Location, Address),
    arg(5, Bundle, Tokens),
    carrier(Program),
    catch(( agent_create(clauses(Program), Carrier,
                         [ host(tartarus_gate), tokens(Tokens),
                           facts([bundle(Address, Bundle)]) ]),
            agent_join(Carrier, Outcome, inf),
            result(Outcome, Carrier, Result)
          ),
          error(Formal, _),
          Result = missed(Formal)).

carrier([ (:- agent(tartarus_carrier, [state([bundle/2])])),
          (main :-
               bundle(Address, Bundle),
               catch(move(Address), error(Why, _), true),
               (   var(Why)
               ->  tartarus_moves:land(Bundle)
               ;   self(Me),
                   tartarus_moves:turn_back(Me, Why)
               ))
        ]).

turn_back(Carrier, Why) :-
    assertz(turned_back(Carrier, Why)).

result(_, Carrier, Result) :-
    retract(turned_back(Carrier, Why)),
    !,
    (   Why = move_refused(_, token)
    ->  Result = refused
    ;   Result = missed(Why)
    ).
result(done, _, landed) :-
    !.
result(Outcome, _, missed(Outcome)).

%!  land(+Bundle) is det.
%
%   Install and run the agent in Bundle, which has arrived.

land(bundle(Name, Handler, Payload, Clauses, Tokens, From, Time)) :-
    here(Here),
    life_begin(Name, Here, Handler, Tokens, Payload, Clauses),
    arrived(Name),
    get_time(Now),
    Seconds is Now-Time,
    hop_done(in, Name, From, Here, Seconds),
    run_handler(Name, Handler, main, now).

arrived(Name) :-
    (   verbosity(1)
    ->  print_lines("Agent bearing ~w has arrived to this platform. ~n", [Name])
    ;   print_lines("  ~n", [])
    ).

                /*******************************
                *        TIMES OF HOPS         *
                *******************************/

:- dynamic hop/6.                       % Way, Agent, From, To, Date, Seconds

%   At most twice as many hops are kept, of both directions together.

kept(10000).

%   hop_done(+Way, +Agent, +From, +To, +Seconds): Way is `in` or `out`.

hop_done(Way, Agent, From, To, Seconds) :-
    get_time(Now),
    date(Now, Date),
    assertz(hop(Way, Agent, From, To, Date, Seconds)),
    predicate_property(hop(_, _, _, _, _, _), number_of_clauses(Count)),
    kept(Most),
    (   Count > 2*Most
    ->  ignore(retract(hop(_, _, _, _, _, _)))
    ;   true
    ).

date(Stamp, (Day,Minute)) :-
    stamp_date_time(Stamp, date(Y, M, D, H, Mn, _, _, _, _), local),
    format(atom(Day), '~d/~d/~d', [D,M,Y]),
    format(atom(Minute), '~d:~d', [H,Mn]).

%!  in_hop_time(?Agent, ?Seconds) is nondet.
%!  out_hop_time(?Agent, ?Seconds) is nondet.
%!  in_hop_time(?Agent, ?From, ?To, ?Date, ?Seconds) is nondet.
%!  out_hop_time(?Agent, ?From, ?To, ?Date, ?Seconds) is nondet.
%
%   @arg Date is (Day,Minute), two atoms as '21/11/2026' and '14:7'

in_hop_time(Agent, Seconds) :-
    in_hop_time(Agent, _, _, _, Seconds).

out_hop_time(Agent, Seconds) :-
    out_hop_time(Agent, _, _, _, Seconds).

in_hop_time(Agent, From, To, Date, Seconds) :-
    hop(in, Agent, From, To, Date, Seconds).

out_hop_time(Agent, From, To, Date, Seconds) :-
    hop(out, Agent, From, To, Date, Seconds).

%!  in_hop_times_info(-List) is det.
%!  out_hop_times_info(-List) is det.
%!  in_hop_times_details(-List) is det.
%!  out_hop_times_details(-List) is det.
%
%   List are the kept hops: (Agent,Seconds), or (Agent,From,To,Date,Seconds).

in_hop_times_info(List) :-
    findall((Agent,Seconds), in_hop_time(Agent, Seconds), List).

out_hop_times_info(List) :-
    findall((Agent,Seconds), out_hop_time(Agent, Seconds), List).

in_hop_times_details(List) :-
    details(in, List).

out_hop_times_details(List) :-
    details(out, List).

details(Way, List) :-
    findall((Agent,From,To,Date,Seconds),
            hop(Way, Agent, From, To, Date, Seconds),
            List).

%!  in_hop_time_stat(-Max, -Min, -Mean) is det.
%!  out_hop_time_stat(-Max, -Min, -Mean) is det.
%!  overall_hop_time_stat(-Max, -Min, -Mean) is det.
%
%   The longest, the shortest and the mean time; 0 each before the first hop.

in_hop_time_stat(Max, Min, Mean) :-
    stat(in, Max, Min, Mean).

out_hop_time_stat(Max, Min, Mean) :-
    stat(out, Max, Min, Mean).

overall_hop_time_stat(Max, Min, Mean) :-
    stat(_, Max, Min, Mean).

stat(Way, Max, Min, Mean) :-
    (   aggregate_all(r(max(S), min(S), sum(S), count),
                      hop(Way, _, _, _, _, S),
                      r(Max0, Min0, Sum, Count))
    ->  Max = Max0,
        Min = Min0,
        Mean is Sum/Count
    ;   Max = 0,
        Min = 0,
        Mean = 0
    ).

%!  hoptime(?Agent, ?From, ?To, ?Seconds) is nondet.

hoptime(Agent, From, To, Seconds) :-
    out_hop_time(Agent, From, To, _, Seconds).
