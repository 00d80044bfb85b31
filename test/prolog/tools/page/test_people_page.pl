:- module(test_people_page, []).
:- use_module('../../../lib/common').
:- use_module('../../../lib/fixtures', [capturing/2]).
:- use_module('../../../lib/pages', [ask/3, got/3, posted/4]).
:- use_module(library(debug), [assertion/1]).
:- use_module(library(lists), [member/2]).
:- use_module(library(plunit)).
:- use_module(library(process), [process_create/3, process_kill/2, process_wait/2]).
:- use_module(library(readutil), [read_line_to_string/2]).
:- use_module(library(socket), [tcp_connect/3]).
:- use_module(library(thread), [concurrent_maplist/3]).
:- use_module(library(typhon)).
:- use_module(library(uri), [uri_components/2]).

/** <module> People answer by their links

*Threading*: one test at a time; several clients at once.
*/

:- meta_predicate with_class(+, -, 0).

with_class(Names, Links, Goal) :-
    no_leaks(setup_call_cleanup(
                 ( host_start(desk),
                   people_start(Names, Links, [port(0), link(desk)]) ),
                 once(Goal),
                 ( people_stop,
                   forall(member(Host, [desk|Names]), host_stop(Host)) ))).

asks(Host, Body, Agent) :-
    agent_create(clauses([(:- agent(asks, [])), (main :- Body)]), Agent,
                 [host(Host)]).

page(Link, Page) :-
    ask(Link, _{ask:"page"}, Answer),
    Page = Answer.answer.

%   waits(+Link, -Question): the person sees a question.

waits(Link, Question) :-
    wait_until(( page(Link, Page), [Question|_] = Page.questions ), 20).

answer(Link, Question, Given, Answer) :-
    ask(Link, _{do:"answer", number:Question.number, answer:Given}, Answer).

:- begin_tests(people_page).

test(class_votes_and_each_vote_counts_once, Votes == [3,3,3,3]) :-
    with_class([anna, ben, carla, dan], Links, vote(Links, Votes)).

%   Each sends the answer twice, as a phone does that has lost its connection.

vote(Links, Votes) :-
    agent_create(clauses([ (:- agent(votes, [])),
                           (main :- neighbours(Hosts), visit(Hosts, Votes),
                                    result(Votes)),
                           visit([], []),
                           (visit([Host|Hosts], [Vote|More]) :-
                                move(Host), choose("Trip?", [1,2,3,4], Vote),
                                show(voted(Vote)), visit(Hosts, More)) ]),
                 Agent, [host(desk)]),
    concurrent_maplist(votes, Links, Outcomes),
    forall(member(Outcome, Outcomes),
           assertion(Outcome = [_{answer:_}, _{error:_}])),
    agent_result(Agent, Votes, 20).

votes(_-Link, [First, Second]) :-
    waits(Link, Question),
    assertion(Question.choices == ["1", "2", "3", "4"]),
    answer(Link, Question, 3, First),
    answer(Link, Question, 4, Second).

test(link_opens_the_questions_of_its_person_alone) :-
    with_class([anna, ben], Links, apart(Links)).

apart([anna-Anna, ben-Ben]) :-
    asks(anna, ( ask("<script>alert(1)</script>", A), result(A) ), Agent),
    waits(Anna, Question),
    assertion(Question.text == "<script>alert(1)</script>"),
    page(Ben, Page),
    assertion(Page.questions == []),
    answer(Ben, Question, "from ben", Wrong),
    assertion(get_dict(error, Wrong, _)),
    answer(Anna, Question, "halt.", _),
    agent_result(Agent, "halt.", 20).

test(only_a_valid_link_is_answered, Statuses == [403,403,403,403,404,404,404,405]) :-
    with_class([anna, ben], Links, strangers(Links, Statuses)).

strangers([anna-Old, ben-Ben], Statuses) :-
    people_start([anna], [anna-Revoked], []),
    people_start([ben], [ben-Expired], [seconds(0)]),
    people_revoke(anna),
    people_start([ben], [ben-Ben2], []),
    assertion(Ben2 \== Ben),
    findall(Status,
            ( member(Link-Name, [ Old-'', Revoked-ask, Expired-'', Ben-'',
                                  Ben2-'main.js', Ben2-feed, Ben2-metrics,
                                  Ben2-ask ]),
              atom_concat(Link, Name, Address),
              got(Address, [], Status) ),
            Statuses),
    got(Ben2, [], 200).

test(foreign_and_large_requests_are_refused, Statuses == [403,413]) :-
    with_class([anna], [anna-Link], foreign(Link, Statuses)).

foreign(Link, [Foreign, Large]) :-
    atom_concat(Link, ask, Address),
    posted(Address, json(_{ask:"page"}),
           [request_header('Origin'='http://evil.example')], Foreign),
    uri_components(Address, uri_components(_, Authority, Path, _, _)),
    atomic_list_concat([Host, Port0], :, Authority),
    atom_number(Port0, Port),
    setup_call_cleanup(
        tcp_connect(Host:Port, Pair, []),
        ( set_stream(Pair, timeout(60)),
          format(Pair, 'POST ~w HTTP/1.1\r\nHost: ~w\r\n\c
                        Content-Length: 30000\r\n\r\n', [Path, Authority]),
          flush_output(Pair),
          read_line_to_string(Pair, Line) ),
        close(Pair, [force(true)])),
    split_string(Line, " ", "", [_, Text|_]),
    number_string(Large, Text).

test(links_need_an_address_that_others_reach,
     error(existence_error(option, advertise(_)))) :-
    people_start([anna], _, [port(0), bind('0.0.0.0')]).
test(links_are_printed_as_qr_codes,
     [condition(missing([qrencode], [])), nondet]) :-
    printed(Messages),
    member(informational-typhon(person(anna, Link)), Messages),
    member(informational-typhon(qr_code(anna, Lines)), Messages),
    process_create(path(qrencode), ['-t', 'UTF8', '-m', '2', Link],
                   [stdout(pipe(Out, [encoding(utf8)]))]),
    read_string(Out, _, Text),
    close(Out),
    atomic_list_concat(Lines, '\n', Printed),
    assertion(atom_string(Printed, Text)).
test(missing_qrencode_is_reported_once_and_links_remain, Warnings == [no_qr_code]) :-
    getenv('PATH', Path),
    setup_call_cleanup(setenv('PATH', '/nowhere'), printed(Messages),
                       setenv('PATH', Path)),
    findall(Name, member(_-typhon(person(Name, _)), Messages), [anna, ben]),
    findall(Warning, member(warning-typhon(Warning), Messages), Warnings).

printed(Messages) :-
    no_leaks(setup_call_cleanup(
                 true,
                 capturing(people_start([anna, ben], [port(0), qr(true)]),
                           Messages),
                 ( people_stop, host_stop(anna), host_stop(ben) ))).

test(other_hosts_have_no_links, error(permission_error(invite, host, desk))) :-
    with_class([anna], _, people_start([desk], _, [])).

:- end_tests(people_page).

%   With a journal: the process ends, and begins again with its questions, links
%   and waiting agents.

:- needs([journal]).

:- begin_tests(people_journal).

test(question_answer_and_link_outlive_their_process,
     forall(member(When, [before, after]))) :-
    no_leaks(with_tmp_dir(Dir, outlives(When, Dir))).

outlives(When, Dir) :-
    free_port(Port),
    setup_call_cleanup(
        host_start(anna, [journal(Dir), people(true)]),
        ( people_start([anna], [_-Link], [port(Port)]),
          asks(anna, ( ask(x, A), ask(y, B), result(A+B) ), Agent),
          waits(Link, First),
          (   When == before
          ->  answer(Link, First, "1", _),
              wait_until(( waits(Link, Next), Next.text == "y" ), 20)
          ;   true
          ) ),
        ( people_stop, host_stop(anna) )),
    setup_call_cleanup(
        host_start(anna, [journal(Dir), people(true)]),
        ( people_start([], [], [port(Port)]),
          ( When == after -> waits(Link, Again), answer(Link, Again, "1", _)
          ; true ),
          wait_until(( waits(Link, Second), Second.text == "y" ), 20),
          answer(Link, Second, "2", _),
          agent_result(Agent, "1"+"2", 20) ),
        ( people_stop, host_stop(anna) )).

%   killed(+Dir, +Ports, +Names, -Links, :Goal): a process with the journal in
%   Dir is killed after Goal.

:- meta_predicate killed(+, +, +, -, 0).

test(answer_counts_once_although_its_process_is_killed,
     forall(member(When, [before, after]))) :-
    no_leaks(with_tmp_dir(Dir, survives(When, Dir))).

survives(When, Dir) :-
    free_port(Port),
    free_port(Web),
    format(atom(Host), 'anna@127.0.0.1:~d', [Port]),
    setup_call_cleanup(
        host_start(driver),
        ( killed(Dir, Port-Web, [anna], [_-Link], put(When, Host, Link, First)),
          killed(Dir, Port-Web, [], [], taken(When, Host, Link, First)) ),
        host_stop(driver)).

put(When, Host, Link, First) :-
    agent_create(clauses([ (:- agent(asks, [])),
                           (main :- ask(x, A), leave(got(A)),
                                    ask(y, B), leave(got(B)), receive(_-end)) ]),
                 _, [host(Host)]),
    waits(Link, First),                 % so it is committed
    ( When == after -> answer(Link, First, "1", _{answer:_}) ; true ).

taken(When, Host, Link, First) :-
    ( When == before -> answer(Link, First, "1", _{answer:_}) ; true ),
    answer(Link, First, "1", _{error:_}),
    wait_until(( waits(Link, Next), Next.text == "y" ), 20),
    answer(Link, Next, "2", _{answer:_}),
    wait_until(remote(Host, sense(got("2"))), 20),
    remote(Host, findall(Got, sense(got(Got)), Gots)),
    assertion(Gots == ["1", "2"]),
    page(Link, Page),
    assertion(Page.questions == []).

killed(Dir, Port-Web, Names, Links, Goal) :-
    project_file('prolog/typhon.pl', Library),
    format(atom(Start),
           'host_start(anna, [journal(~q), port(~d), people(true)]), \c
            people_start(~q, Links, [port(~d)]), \c
            writeq(Links), writeln(\'.\'), flush_output, thread_get_message(x)',
           [Dir, Port, Names, Web]),
    with_swipl(['-g', Start, Library], Pid, _, Out,
               ( read(Out, Links),
                 call(Goal),
                 process_kill(Pid, kill),
                 process_wait(Pid, _) )).

:- end_tests(people_journal).
