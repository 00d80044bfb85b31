:- module(test_members, []).

% Members of a fleet, its hosts, tags and changes, with a real engine.

:- use_module('../../../lib/common').
:- use_module('../../../lib/texts', [message_text/2]).
:- use_module('../../../lib/fixtures').
:- use_module('../../../lib/peers').
:- use_module('../../../lib/redis').
:- use_module('../../../lib/relay', [relay_start/4, relay_stop/1]).
:- use_module(library(debug), [assertion/1]).
:- use_module(library(lists), [append/3, member/2, memberchk/2]).
:- use_module(library(plunit)).
:- use_module(library(typhon)).
:- use_module(library(typhon/options/fleet/engine), [engine_script/4]).

:- needs([fleet]).

%   hosts(+Options, -Names): as fleet_hosts/3, without endpoints.

hosts(Options, Names) :-
    fleet_hosts(lab, Hosts, Options),
    findall(Name, ( member(Host, Hosts),
                    atomic_list_concat([Name|_], @, Host) ),
            Names).

listed(Options, Names) :-
    wait_until(test_members:sorted(Options, Names), 10).

sorted(Options, Names) :-
    catch(hosts(Options, Names0), error(_, _), fail),
    sort(Names0, Names).

%   changes are collected in the order in which a watch tells them.

:- dynamic change/1.

note(Change) :-
    Change =.. [What,Host],
    atomic_list_concat([Name|_], @, Host),
    (   Name == alpha                   % at load its own lease may lapse
    ->  true
    ;   assertz(change(What-Name))
    ).

:- meta_predicate watched(0, +).

watched(Goal, Changes) :-
    retractall(change(_)),
    fleet_watch(lab, note, Watch),
    call_cleanup(( call(Goal),
                   wait_until(test_members:changed(Changes), 20) ),
                 fleet_unwatch(Watch)).

changed(Changes) :-
    findall(Change, change(Change), All),
    append(Changes, _, All).

chosen(Tag, Name) :-
    create([(main :- receive(_))], A, [host(any(Tag))]),
    agent_property(A, host(Host)),
    atomic_list_concat([Name|_], @, Host).

:- begin_tests(members).

test(host_is_known_when_host_start_returns, Names == [alpha]) :-
    with_fleet([], _, [alpha-[robot]], hosts([tag(robot), state(up)], Names)).

test(hosts_have_all_tags_of_a_list, Each == [[a,b],[b,c],[b],[a,b,c]]) :-
    with_fleet([], _, [a-[red], b-[red,round], c-[round]],
               findall(Names,
                       ( member(Tags, [[tag(red)], [tag(round)],
                                       [tag([round,red])], []]),
                         sorted(Tags, Names) ),
                       Each)).

test(least_loaded_host_is_first, Names == [beta,alpha]) :-
    with_fleet([lease(0.3)], _, [alpha-[], beta-[]],
               ( forall(between(1, 3, _),
                        create([(main :- receive(_))], _, [host(alpha)])),
                 wait_until(test_members:hosts([], [beta,alpha]), 10),
                 hosts([], Names) )).

test(hosts_near_a_host_are_those_it_has_links_to_first, Names == [b,d,a,c]) :-
    with_fleet([], _, [a-[], b-[], c-[], d-[]],
               ( link(b, d), hosts([near(b)], Names) )).

test(own_choices_count, Hosts == [a,a,a,b,b,b]) :-
    with_fleet([], _, [a-[x], b-[x]],
               ( findall(A, ( between(1, 6, _),
                              create([(main :- receive(_))], A, [host(any(x))]) ),
                         Agents),
                 findall(Host, ( member(A, Agents), agent_property(A, host(H)),
                                 atomic_list_concat([Host|_], @, H) ),
                         Hosts0),
                 msort(Hosts0, Hosts) )).

test(each_fleet_is_asked_for_a_tag,
     Here-Formal == beta-existence_error(tag, nobody)) :-
    with_fleet([], Redis, [alpha-[robot]],
               ( redis_address(Redis, Address),
                 setup_call_cleanup(
                     fleet_join(attic, [redis(Address)]),
                     ( host_start(beta, [fleet(attic), tags([y])]),
                       chosen(y, Here),
                       catch(create([(main :- true)], _, [host(any(nobody))]),
                             error(Formal, _), true),
                       host_stop(beta) ),
                     fleet_leave(attic)) )).

test(choices_of_an_engine_end_with_it, Host == b) :-
    with_settings([typhon_fleet:choice_seconds=60],
                  ( with_fleet([], _, [a-[x]], chosen(x, a)),
                    with_fleet([], _, [b-[x]], chosen(x, Host)) )).

test(tags_change, Names == [alpha]) :-
    with_fleet([lease(0.3)], _, [alpha-[robot]],
               ( host_change(alpha, tags([camera])),
                 wait_until(test_members:hosts([tag(robot)], []), 10),
                 hosts([tag(camera)], Names) )).

test(host_that_stops_leaves, Names == [alpha]) :-
    with_fleet([], _, [alpha-[], beta-[]],
               watched(( host_stop(beta), listed([], [alpha]) ),
                       [left-beta])),
    Names = [alpha].

test(process_that_leaves_takes_its_hosts_along) :-
    with_redis(Redis, leaving(Redis)).

leaving(Redis) :-
    redis_address(Redis, Address),
    member_spec(Redis, beta, [], [tags([x])], Beta),
    fleet_join(lab, [redis(Address)]),
    call_cleanup(
        with_peers([Beta],
                   ( listed([], [beta]),
                     peer_do(beta, fleet_leave(lab)),
                     listed([], []),
                     peer_do(beta, fleet_join(lab, [redis(Address)])),
                     listed([tag(x)], [beta]) )),
        fleet_leave(lab)).

test(end_of_prolog_leaves) :-
    with_fleet([], Redis, [alpha-[]],
               watched(lives_once(Redis), [joined-beta,left-beta])).

lives_once(Redis) :-
    redis_address(Redis, Address),
    format(atom(Goal),
           'fleet_join(lab, [redis(~q)]), host_start(beta, [fleet(lab)])',
           [Address]),
    project_file('prolog/typhon.pl', Typhon),
    run_swipl(['-g', Goal, '-t', halt, Typhon], [], Status, _, _),
    assertion(Status == exit(0)).

test(suspended_process_is_away_and_comes_back) :-
    with_fleet([lease(2)], Redis, [alpha-[]],
               ( member_spec(Redis, beta, [lease(2)], [], Beta),
                 watched(with_peers([Beta], suspended),
                         [joined-beta,away-beta,back-beta]) )).

suspended :-
    listed([state(up)], [alpha,beta]),
    peer_signal(beta, stop),
    listed([state(away)], [beta]),
    listed([state(up)], [alpha]),
    listed([], [alpha,beta]),
    peer_signal(beta, cont),
    listed([state(up)], [alpha,beta]).

test(killed_process_is_away_and_back_when_it_starts_again) :-
    with_fleet([lease(2)], Redis, [alpha-[]],
               ( member_spec(Redis, beta, [lease(2)], [], Beta),
                 watched(with_peers([Beta],
                                    ( peer_kill(beta),
                                      listed([state(away)], [beta]),
                                      peer_restart(beta) )),
                         [joined-beta,away-beta,back-beta]) )).

test(changes_during_a_lost_connection_are_seen) :-
    with_fleet([lease(0.6)], Redis, [alpha-[]],
               watched(( redis_signal(Redis, kill),
                         host_start(beta, [fleet(lab)]),
                         redis_restart(Redis) ),
                       [joined-beta])).

:- end_tests(members).

:- begin_tests(engines).

test(outage_longer_than_a_lease_lapses_no_member) :-
    with_fleet([], Redis, [alpha-[]],
               ( member_spec(Redis, beta, [], [], Beta),
                 with_peers([Beta], out(Redis)) )).

%   For the engine more than a lease has passed since the last beat.

out(Redis) :-
    listed([state(up)], [alpha,beta]),
    redis_line(Redis,
               [ eval, "local p = 'f:{lab}:' redis.call('SET', p..'grace', 0) \c
                        redis.call('DECRBY', p..'last', 61000) \c
                        for _, e in ipairs(redis.call('ZRANGE', p..'lease', 0, -1)) \c
                        do redis.call('ZINCRBY', p..'lease', -61000, e) end",
                 0 ], _),
    typhon_members:fleet_told(lab),
    peer_do(beta, typhon_members:fleet_told(lab)),
    listed([state(up)], [alpha,beta]),
    redis_line(Redis, [xrange, 'f:{lab}:events', -, +], Lines),
    assertion(\+ memberchk("away", Lines)).

test(engine_that_lost_all_is_filled_again) :-
    with_fleet([lease(0.6)], Redis, [alpha-[x]],
               ( member_spec(Redis, beta, [lease(0.6)], [tags([x])], Beta),
                 with_peers([Beta],
                            ( listed([], [alpha,beta]),
                              redis_empty(Redis),
                              listed([tag(x), state(up)], [alpha,beta]) )) )).

test(engine_that_is_gone_delays_the_start_of_a_host_by_a_lease, true) :-
    with_fleet([lease(0.6)], Redis, [],
               ( redis_signal(Redis, kill),
                 forall(member(Host, [alpha, beta]),
                        ( capturing(host_start(Host, [fleet(lab)]), Messages),
                          assertion(was_printed(warning,
                                        typhon(fleet_later(Host, lab)))),
                          assertion(Messages = [_]) )),
                 redis_restart(Redis),
                 listed([], [alpha,beta]) )).

test(question_to_an_engine_that_is_gone,
     throws(error(resource_error(fleet(lab)), _))) :-
    with_fleet([], Redis, [],
               ( redis_signal(Redis, kill), hosts([], _) )).

test(hops_go_on_without_the_engine, Outcome == done) :-
    with_fleet([lease(0.6)], Redis, [alpha-[], beta-[]],
               ( redis_signal(Redis, kill),
                 create([(main :- move(beta), move(alpha))], Agent,
                        [host(alpha)]),
                 joined(Agent, Outcome) )).

%   Each answer takes longer than a sixth of a lease, after which a report ends,
%   so that the lease is renewed before the next 500 agents.

test(report_of_many_agents_to_a_slow_engine_has_parts, Counts == [500,1000,1100]) :-
    no_leaks(with_redis(Redis, slow(Redis, Counts))).

slow(Redis, Counts) :-
    redis_address(Redis, Interface:Port),
    atomic_list_concat([Interface,Port], :, Target),
    setup_call_cleanup(
        relay_start(Target, late, Relay, Address),
        ( atomic_list_concat([_,Relayed], :, Address),
          atom_number(Relayed, Number),
          fleet_join(lab, [redis(Interface:Number), lease(1), report(600)]),
          call_cleanup(reports(Redis, Counts),
                       ( host_stop(alpha), fleet_leave(lab) )) ),
        relay_stop(Relay)).

reports(Redis, Counts) :-
    host_start(alpha, [fleet(lab)]),
    forall(between(1, 1100, _), create([(main :- receive(_))], _, [host(alpha)])),
    host_property(alpha, address(Address)),
    atomic_list_concat([_,Endpoint], @, Address),
    atom_concat('f:{lab}:agents:', Endpoint, Key),
    findall(Count,
            ( between(1, 3, _),
              forall(typhon_members:work(lab), true),
              redis_line(Redis, [hlen, Key], [Text]),
              number_string(Count, Text) ),
            Counts).

late(_, _, Direction, In, Out) :-
    repeat,
    fill_buffer(In),
    read_pending_codes(In, Codes, []),
    (   Codes == []
    ->  !
    ;   ( Direction == down -> sleep(0.2) ; true ),
        format(Out, '~s', [Codes]),
        flush_output(Out),
        fail
    ).

:- end_tests(engines).

:- begin_tests(fleet_errors).

wrong(fleet_join(lab, []), existence_error(option, redis)).
wrong(fleet_join(lab, [redis(localhost:1)]), resource_error(fleet(lab))).
wrong(fleet_join(lab, [reds(localhost:1)]),
      domain_error(fleet_option, reds(localhost:1))).
wrong(fleet_join(lab, [sentinel(m), sentinels([localhost:1])]),
      resource_error(fleet(lab))).
wrong(fleet_join('a@b', [redis(localhost:1)]), domain_error(fleet_name, 'a@b')).
wrong(fleet_join(_, []), instantiation_error).
wrong(fleet_leave(lab), existence_error(fleet, lab)).
wrong(fleet_hosts(lab, _, []), existence_error(fleet, lab)).
wrong(fleet_watch(lab, print, _), existence_error(fleet, lab)).
wrong(fleet_unwatch(nothing), existence_error(fleet_watch, nothing)).
wrong(host_start(alpha, [fleet(lab)]), existence_error(fleet, lab)).
wrong(host_start(alpha, [tags([x])]), existence_error(option, fleet)).

wrong(engine_script(lab, overview, [], _),
      existence_error(fleet, lab)).

%   says(?Formal, ?Part): the message has this Part.

says(resource_error(fleet(lab)), "the fleet lab cannot be reached").
says(resource_error(fleet_space(lab)), "the fleet lab has no space left").
says(permission_error(authenticate, fleet, lab),
     "the fleet lab does not accept the user and password").

test(messages_of_errors, [forall(says(Formal, Part)), nondet]) :-
    message_text(error(Formal, _), Text),
    sub_string(Text, _, _, _, Part).

test(without_a_fleet, [forall(wrong(Goal, Formal)),
                       throws(error(Formal, _))]) :-
    no_leaks(Goal).

wrong_in_fleet(fleet_join(lab, [redis(localhost:1)]),
               permission_error(join, fleet, lab)).
wrong_in_fleet(fleet_hosts(lab, _, [tag(robto)]), existence_error(tag, robto)).
wrong_in_fleet(fleet_hosts(lab, _, [tg(x)]),
               domain_error(fleet_hosts_option, tg(x))).
wrong_in_fleet(fleet_hosts(lba, _, []), existence_error(fleet, lba)).
wrong_in_fleet(host_start(b, [fleet(lab), tags(['a\nb'])]),
               domain_error(tag_name, 'a\nb')).

test(in_a_fleet, [forall(wrong_in_fleet(Goal, Formal)),
                  throws(error(Formal, _))]) :-
    with_fleet([], _, [alpha-[robot]], Goal).

test(wrong_password, throws(error(permission_error(authenticate, fleet, lab),
                                  _))) :-
    no_leaks(with_redis(['--requirepass', secret], Redis,
                        ( redis_address(Redis, Address),
                          fleet_join(lab, [redis(Address), password(other)]) ))).

test(password_and_user, Names == []) :-
    no_leaks(with_redis(['--requirepass', secret], Redis,
                        ( redis_address(Redis, Address),
                          fleet_join(lab, [redis(Address), password(secret)]),
                          call_cleanup(hosts([], Names), fleet_leave(lab)) ))).

:- end_tests(fleet_errors).
