:- module(test_metrics, []).

% Metrics of a network for Prometheus.

:- use_module('../../../lib/common').
:- use_module('../../../lib/fixtures').
:- use_module(library(debug), [assertion/1]).
:- use_module(library(lists), [member/2]).
:- use_module(library(plunit)).
:- use_module(library(process), [process_create/3, process_wait/2]).
:- use_module(library(typhon)).
:- use_module(library(typhon/options/watch), [metrics/2]).

:- needs([prometheus]).

%   promtool(+Text, -Status, -Said)

promtool(Text, Status, Said) :-
    process_create(path(promtool), [check, metrics],
                   [ stdin(pipe(In, [encoding(utf8)])), stdout(null),
                     stderr(pipe(Err)), process(Pid) ]),
    format(In, '~s', [Text]),
    close(In),
    read_string(Err, _, Said),
    close(Err),
    process_wait(Pid, exit(Status)).

%   has_metric(+Text, +Name, +Rest): Text has a line for Name that ends with
%   Rest.

has_metric(Text, Name, Rest) :-
    said(Text, Name, Rest, _),
    !.

said(Text, Name, Rest, Line) :-
    split_string(Text, "\n", "", Lines),
    member(Line, Lines),
    string_concat(Name, "{", Start),
    string_concat(Start, _, Line),
    string_concat(_, Rest, Line).

:- begin_tests(metrics).

test(no_agents, Status-Said == 0-"") :-
    with_hosts([alpha], metrics(alpha, Text)),
    promtool(Text, Status, Said),
    assertion(has_metric(Text, "typhon_hosts", "} 1")),
    assertion(\+ sub_string(Text, _, _, _, "typhon_agents{")).

test(counts_of_events, Status-Said == 0-"") :-
    with_hosts([alpha, beta], happened(Text)),
    promtool(Text, Status, Said),
    forall(member(Name-Line,
                  [ typhon_agents-",program=\"test\",state=\"resident\"} 1",
                    typhon_agents-",program=\"test\",state=\"faulty\"} 1",
                    typhon_agents_created_total-"} 3",
                    typhon_agents_ended_total-"} 1",
                    typhon_faults_total-"} 1",
                    typhon_messages_total-",direction=\"received\"} 1",
                    typhon_hop_seconds_bucket-",le=\"+Inf\"} 2",
                    typhon_hop_seconds_bucket-",le=\"10.0\"} 2",
                    typhon_hop_seconds_count-"} 2" ]),
           assertion(has_metric(Text, Name, Line))).

happened(Text) :-
    metrics([alpha, beta], _),          % counting begins here
    create([(main :- move(beta), move(alpha))], A, [host(alpha)]),
    joined(A, done),
    create([on_message(_, _)], B, [host(alpha)]),
    agent_send(B, hello),
    capturing(( create([(main :- foo(_) is _)], C, [host(beta)]),
                wait_state(C, faulty(_)) ), _),
    wait_until(received_one, 5),
    wait_state(B, resident),            % B has handled the message
    metrics([alpha, beta], Text).

received_one :-
    metrics(alpha, Text),
    has_metric(Text, typhon_messages_total, "direction=\"received\"} 1").

test(counting_begins_with_the_first_request) :-
    with_hosts([alpha],
               ( create([main], A), joined(A, done),
                 assertion(\+ typhon_events:event_subscribed(life)) )).

%   Names are escaped as data.

hostile('a"b\\c\nd{e="f"} 7').
hostile('<img src=x onerror=alert(1)>').
hostile('Ωμέγα ').

test(hostile_names, [forall(hostile(Name)), Status-Said == 0-""]) :-
    with_hosts([alpha],
               ( agent_create(clauses([ (:- agent(Name, [])),
                                        on_message(_, _) ]),
                              _, [name(plain)]),
                 metrics(alpha, Text) )),
    promtool(Text, Status, Said),
    findall(Line, said(Text, typhon_agents, "state=\"resident\"} 1", Line),
            Found),
    assertion(Found = [_]).

test(all_processes, Up == [1, 1]) :-
    no_leaks(( network_start(ring(4), Network, [processes(2)]),
               metrics(Network, Text),
               network_stop(Network) )),
    assertion(has_metric(Text, typhon_hosts, "} 2")),
    findall(1, said(Text, typhon_up, "} 1", _), Up).

:- end_tests(metrics).
