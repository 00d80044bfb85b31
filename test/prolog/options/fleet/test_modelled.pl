:- module(test_modelled, []).

% The modelled engine of a fleet: it answers as the scripts in Redis do, in random
% sequences of calls with a clock that the test sets; and fleets in virtual time.

:- use_module('../../../lib/common').
:- use_module('../../../lib/fixtures').
:- use_module('../../../lib/networks').
:- use_module('../../../lib/redis').
:- use_module(library(debug), [assertion/1]).
:- use_module(library(lists), [append/2, append/3, member/2, nth1/3]).
:- use_module(library(plunit)).
:- use_module(library(random),
              [random_between/3, random_member/2, random_subseq/3]).
:- use_module(library(readutil), [read_file_to_string/3]).
:- use_module(library(typhon)).
:- use_module(library(typhon/options/fleet/engine), [engine/3]).
:- use_module(library(typhon/options/fleet/modelled),
              [modelled_close/1, modelled_open/1, modelled_script/5]).

:- needs([fleet]).

                /*******************************
                *         RANDOM CALLS         *
                *******************************/

%   random_call(+Entries, -Script, -Redis, -Model): the arguments for both, which
%   differ in the Entries of a process: E-Redis-Model, as each has named one.

random_call(Entries, take, Redis, Model) :-
    maybe_often,
    !,
    endpoint(E),
    token(Token),
    random_subseq([h, i], Names, _),
    hosts_at(E, Names, Hosts),
    length(Hosts, Count),
    random_subseq(Entries, Some, _),
    findall(R, member(E-R-_, Some), Rs),
    findall(M, member(E-_-M, Some), Ms),
    append([[E,Token,'0-0',Count], Hosts, Rs], Redis),
    append([[E,Token,'0-0',Count], Hosts, Ms], Model).
random_call(_, Script, Args, Args) :-
    random_member(Script, [ beat, beat, beat, leave, hosts, where, ends, known,
                            park, park, park, mail, mail, unpark, parked ]),
    args(Script, Args).

maybe_often :-
    random_between(1, 4, 1).

endpoint(E) :-
    random_member(E, ['a:1', 'b:2', 'c:3', 'd:4']).

token(Token) :-
    random_member(Token, [7, 7, 7, 8]).

hosts_at(E, Names, Hosts) :-
    findall(H, ( member(Name, Names), atomic_list_concat([Name,E], @, H) ),
            Hosts).

host(Host) :-
    endpoint(E),
    random_member(Name, [h, i]),
    hosts_at(E, [Name], [Host]).

agent(Id) :-
    random_between(1, 5, N),
    random_member(Home, ['h@a:1', 'h@b:2']),
    atomic_list_concat([N,Home], @, Id).

text(Text) :-
    random_between(1, 999999999, Number),
    number_string(Number, Text).

args(beat, Args) :-
    endpoint(E),
    token(Token),
    random_member(Ttl, [300, 1000, 3000]),
    random_member(First, [0, 0, 1]),
    random_subseq([h, i], Names, _),
    hosts_at(E, Names, Hosts),
    findall([H,Load,Count|Tags],
            ( member(H, Hosts), random_between(0, 3, Load),
              random_subseq([red, round], Tags, _), length(Tags, Count) ),
            Parts),
    append([[E,Token,Ttl,First,E,1,'','',0]|Parts], Args).
args(leave, [E,Token]) :-
    endpoint(E),
    token(Token).
args(hosts, Tags) :-
    random_subseq([red, round, big], Tags, _).
args(where, [Id,Hops,Host]) :-
    agent(Id),
    random_between(0, 9, Hops),
    host(Host).
args(ends, [Most,Id,Outcome]) :-
    random_between(1, 3, Most),
    agent(Id),
    text(Outcome).
args(known, [Kind,Id]) :-
    random_member(Kind, [agents, ends]),
    agent(Id).
args(park, [E,To,Id,Hops,Ttl,From,Ticket,Known,Most,Bytes,Text]) :-
    endpoint(E),
    atom_concat('h@', E, To),
    agent(Id),
    random_between(0, 9, Hops),
    random_member(Ttl, [0, 300, 5000, inf]),
    host(From),
    random_between(1, 40, Ticket),
    random_member(Known, [0, 1]),
    bounds(Most, Bytes),
    text(Text).
args(mail, [E,Id,Name,Most,Bytes,Text]) :-
    endpoint(E),
    agent(Id),
    random_between(1, 40, N),
    atom_concat(letter, N, Name),
    bounds(Most, Bytes),
    text(Text0),
    random_member(Text, [Text0, Text0, ""]).
args(unpark, [back,Id,Token,Why]) :-
    agent(Id),
    token(Token),
    text(Why).
args(parked, []).

bounds(Most, Bytes) :-
    random_member(Most, [2, 100, 100]),
    random_member(Bytes, [12, 1000, 1000]).

%   Mostly less than a lease, sometimes weeks; an hour is forgotten at once.

passes(Time) :-
    random_between(1, 20, Kind),
    (   Kind == 1
    ->  random_between(3600000, 2000000000, Time)
    ;   Kind < 4
    ->  random_between(1, 10000, Time)
    ;   random_between(1, 400, Time)
    ).

                /*******************************
                *           BOTH ENGINES       *
                *******************************/

redis(Script, Prefix, Now, Args, Reply) :-
    lua(head, Head),
    lua(Script, Body),
    atomic_list_concat([Head,'clock = function() return ',Now,' end\n',Body],
                       Text),
    Command =.. [eval,Text,0,Prefix|Args],
    ( engine(lab, Command, Reply0) -> Reply = Reply0 ; Reply = nil ).

lua(Name, Text) :-
    format(atom(Path), 'prolog/typhon/options/fleet/scripts/~w.lua', [Name]),
    project_file(Path, File),
    read_file_to_string(File, Text, []).

model(Script, Fleet, Now, Args, Reply) :-
    (   modelled_script(Fleet, Now, Script, Args, Reply0)
    ->  Reply = Reply0
    ;   Reply = nil
    ).

%   hour_over(+Prefix, +Time): Redis would forget this after an hour of its own.

hour_over(Prefix, Time) :-
    (   Time >= 3600000
    ->  forall(( member(Kind, ['had:*', 'not:*', 'letter:*']),
                 atom_concat(Prefix, Kind, Pattern),
                 engine(lab, keys(Pattern), Keys),
                 member(Key, Keys) ),
               engine(lab, del(Key), _))
    ;   true
    ).

%   comparable(+Script, +Reply0, -Reply, -Entries): Reply is in an order, and
%   without the names of Entries.

comparable(take, [Last,Rows0], taken(Some,Rows), Entries) :-
    !,
    ( Last == "" -> Some = none ; Some = some ),
    findall(Row, member([_|Row], Rows0), Rows),
    findall(Entry, member([Entry|_], Rows0), Entries).
comparable(parked, Rows0, Rows, []) :-
    !,
    msort(Rows0, Rows).
comparable(hosts, ["unknown",Tag,Tags0], ["unknown",Tag,Tags], []) :-
    !,
    msort(Tags0, Tags).
comparable(_, Reply, Reply, []).

compare(N) :-
    format(atom(Prefix), 'f:{~w}:', [N]),
    setup_call_cleanup(modelled_open(N),
                       steps(80, 1000000000, Prefix-N, [], []),
                       modelled_close(N)).

steps(0, _, _, _, _) :-
    !.
steps(Left, Now0, Prefix-Fleet, Entries0, Done) :-
    passes(Time),
    Now is Now0+Time,
    hour_over(Prefix, Time),
    random_call(Entries0, Script, RedisArgs, ModelArgs),
    redis(Script, Prefix, Now, RedisArgs, Redis0),
    model(Script, Fleet, Now, ModelArgs, Model0),
    comparable(Script, Redis0, Redis, RedisEntries),
    comparable(Script, Model0, Model, ModelEntries),
    Calls = [Now-Script-ModelArgs|Done],
    (   Redis == Model
    ->  true
    ;   throw(different(Redis, Model, Calls))
    ),
    ( ModelArgs = [E|_] -> true ; true ),
    findall(E-R-M, ( nth1(I, RedisEntries, R), nth1(I, ModelEntries, M) ), New),
    append(New, Entries0, Entries),
    Left1 is Left-1,
    steps(Left1, Now, Prefix-Fleet, Entries, Calls).

                /*******************************
                *          VIRTUAL TIME        *
                *******************************/

:- meta_predicate in_lab(+, -, ?, 0).

in_lab(Options, Network, Hosts, Goal) :-
    no_leaks(setup_call_cleanup(
        fleet_join(lab, [engine(modelled), lease(3), report(1)]),
        with_network(line(3),
                     [clock(virtual), seed(7), fleet(lab)|Options], Network,
                     ( network_property(Network, hosts(Hosts)),
                       once(Goal) )),
        fleet_leave(lab))).

away(Network, Host, From, To) :-
    network_at(Network, From, host_change(Host, away(true))),
    network_at(Network, To, host_change(Host, away(false))).

%   goer(+From, +To, +Wait, -Agent): it moves at 10; its result is the error of
%   the move, the host where it is then, its hops, the time, and messages until
%   `last`.

goer(From, To, Wait, Agent) :-
    create([ (main :- sleep(10),
                      catch(( move(To, [wait(Wait)]), R = none ),
                            error(R, _), true),
                      here(Here), hops(Hops), now(Now), all(Ms),
                      result(went(R, Here, Hops, Now, Ms))),
             (all(Ms) :- receive(_-M),
                         ( M == last -> Ms = [] ; Ms = [M|More], all(More) )) ],
           Agent, [host(From)]).

result(Agent, went(R, Here, Hops, Now, Ms)) :-
    agent_result(Agent, went(R, Here, Hops, Now, Ms), 10000).

parked(Ids) :-
    fleet_parked(lab, Parked),
    findall(Id, member(parked(Id, _, _, _), Parked), Ids).

nothing_is_left :-
    forall(member(Fact, [item(_, _, _, _, _), parked(_, _, _, _, _, _, _, _),
                         parcel(_, _, _), claimed(_, _, _), due(_, _, _)]),
           \+ typhon_modelled_engine:Fact).

:- begin_tests(modelled).

test(model_answers_as_redis) :-
    with_fleet([], _, [],
               ( engine(lab, config(set, appendfsync, no), _),
                 forall(between(1, 30, N), compare(N)) )).

test(host_that_is_away_loses_its_lease,
     true([Up1,Away1,Up2] == [[A,C],[B],[A,B,C]])) :-
    in_lab([], N, [A,B,C],
           ( away(N, B, 5, 60),
             network_advance(N, 20),
             fleet_hosts(lab, Up1, [state(up)]),
             fleet_hosts(lab, Away1, [state(away)]),
             network_advance(N, 45),
             fleet_hosts(lab, Up2, [state(up)]) )).

test(agent_waits_for_a_host_and_its_messages_come_in_order,
     true(w(R, Here, Hops, Ms) == w(none, B, 1, [a,b,c]))) :-
    in_lab([], N, [A,B,_],
           ( away(N, B, 5, 60),
             goer(A, B, 100, Agent),
             agent_send(Agent, a),
             network_advance(N, 20),
             assertion(parked([Agent])),
             agent_send(Agent, b),
             network_advance(N, 45),
             agent_send(Agent, c),
             agent_send(Agent, last),
             result(Agent, went(R, Here, Hops, Now, Ms)),
             assertion(( Now >= 60, Now =< 61 )),
             assertion(nothing_is_left) )).

test(agent_returns_when_its_time_is_over,
     true(w(R, Here, Hops) == w(host_unreachable(B), A, 2))) :-
    in_lab([], N, [A,B,_],
           ( away(N, B, 5, 100),
             goer(A, B, 30, Agent),
             agent_send(Agent, last),
             result(Agent, went(R, Here, Hops, Now, _)),
             assertion(( Now >= 40, Now =< 42 )),
             assertion(nothing_is_left) )).

test(agent_on_a_host_that_is_away_is_parked_when_that_is_back,
     true(w(R, Here) == w(none, B))) :-
    in_lab([], N, [A,B,_],
           ( away(N, A, 5, 40),
             goer(A, B, 100, Agent),
             agent_send(Agent, last),
             network_advance(N, 30),
             assertion(parked([])),
             result(Agent, went(R, Here, _, Now, _)),
             assertion(( Now >= 40, Now =< 43 )) )).

test(host_that_goes_while_the_agent_is_on_its_way_out_is_waited_for,
     true(w(R, Here) == w(none, B))) :-
    in_lab([hop_time(uniform(2, 2))], N, [A,B,_],
           ( away(N, B, 11, 40),
             goer(A, B, 100, Agent),
             agent_send(Agent, last),
             result(Agent, went(R, Here, _, _, _)) )).

test(message_waits_for_a_host_that_is_away, true(Got-E == hello-none)) :-
    in_lab([], N, [A,B,_],
           ( create([(main :- receive(_-M), now(T), result(M-T))], Reader,
                    [host(B)]),
             away(N, B, 5, 60),
             create([(main :- sleep(10),
                              catch(( send(Reader, hello), F = none ),
                                    error(F, _), true),
                              result(F))], Sender, [host(A)]),
             agent_result(Sender, E, 100),
             agent_result(Reader, Got-Time, 100),
             assertion(( Time >= 60, Time =< 61 )) )).

test(choices_leave_out_a_host_that_is_away, true(sort(Hosts, [A,C]))) :-
    in_lab([hosts([tags([robot])])], N, [A,B,C],
           ( away(N, B, 5, 100),
             network_advance(N, 20),
             findall(Host,
                     ( between(1, 4, _),
                       create([(main :- here(H), result(H))], Agent,
                              [host(any(robot))]),
                       agent_result(Agent, Host, 10) ),
                     Hosts) )).

test(same_seed_same_run, true(First == Second)) :-
    findall(R, ( between(1, 2, _),
                 in_lab([], N, [A,B,_],
                        ( away(N, B, 5, 60),
                          goer(A, B, 100, Agent),
                          agent_send(Agent, last),
                          result(Agent, R) )) ),
            [First,Second]).

test(hosts_of_a_modelled_fleet_need_virtual_time,
     error(permission_error(model, fleet, lab))) :-
    setup_call_cleanup(fleet_join(lab, [engine(modelled)]),
                       host_start(alpha, [fleet(lab)]),
                       fleet_leave(lab)).

test(modelled_engine_has_no_watches,
     error(permission_error(model, engine_command, _))) :-
    setup_call_cleanup(fleet_join(lab, [engine(modelled)]),
                       fleet_watch(lab, print_message(silent), _),
                       fleet_leave(lab)).

:- end_tests(modelled).
