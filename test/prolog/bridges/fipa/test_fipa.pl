:- module(test_fipa, []).

% Hosts as platforms of FIPA: messages between their agents and those of other
% platforms, wherever they are, and malformed requests.

:- use_module('../../../lib/common').
:- use_module('../../../lib/fipa_agents').
:- use_module('../../../lib/fixtures').
:- use_module('../../../lib/peers').
:- use_module('../../../../app/typhon/fipa/diagnose').
:- use_module(library(apply), [maplist/2]).
:- use_module(library(debug), [assertion/1]).
:- use_module(library(lists), [member/2]).
:- use_module(library(plunit)).
:- use_module(library(socket)).
:- use_module(library(typhon)).
:- use_module(library(typhon/fipa)).

:- meta_predicate
    with_platforms(-, -, 0),
    with_platform(+, -, 0),
    connected(+, -, -, 0).

%   alpha is the platform `a`, reached at UrlA, beta is `b`.

with_platforms(UrlA, UrlB, Goal) :-
    with_hosts([alpha, beta],
               ( platform(alpha, a, [], UrlA),
                 platform(beta, b, [], UrlB),
                 call(Goal) )).

with_platform(Options, Url, Goal) :-
    with_hosts([alpha],
               ( platform(alpha, a, Options, Url),
                 call(Goal) )).

platform(Host, Name, Options, Url) :-
    fipa_start(Host, 'http://127.0.0.1:0/acc', [name(Name)|Options]),
    once(fipa_property(Host, url(Url))).

property(Host, Property) :-
    once(fipa_property(Host, Property)).

echo([ (:- agent(echo, [])),
       (on_message(From, acl(request, Parameters)) :-
            memberchk(content(Content), Parameters),
            reply(acl(request, Parameters), inform, [said(From, Content)])) ]).

echo(Host, Agent) :-
    echo(Clauses),
    agent_create(clauses(Clauses), Agent, [host(Host)]).

:- begin_tests(fipa_agents).

test(agents_talk_across_platforms) :-
    with_platforms(_, Url,
        ( echo(beta, Agent),
          property(beta, name(Agent, Name)),
          does(( self(Me),
                 fipa_request(fipa(Name, [Url]), [f("x", 1)], 10, Outcome) ),
               Me-Outcome),
          property(alpha, name(Me, Mine)),
          assertion(Outcome == inform-[said(fipa(Mine, []), [f("x", 1)])]) )).

test(agents_have_short_names) :-
    with_platforms(_, Url,
        ( echo(beta, _),
          does(fipa_request(fipa('echo@b', [Url]), "x", 10, Outcome), Outcome),
          assertion(Outcome = inform-_) )).

test(agents_of_one_platform_need_no_address) :-
    with_platform([], _,
        ( echo(alpha, _),
          does(fipa_request(fipa('echo@a'), [x], 10, Outcome), Outcome),
          assertion(Outcome = inform-_) )).

%   The `send` of the test agent adds the sender of the message.

test(agents_answer_the_sender) :-
    with_platforms(_, Url,
        ( agent_create(clauses([ (:- agent(polite, [])),
                                 (on_message(From, acl(request, _)) :-
                                      send(From, acl(inform, [content("yes")]))) ]),
                       _, [host(beta)]),
          does(( send(fipa('polite@b', [Url]), acl(request, [])),
                 receive(fipa(_)-acl(inform, Parameters), 10),
                 memberchk(content(Content), Parameters) ), Content),
          assertion(Content == "yes") )).

test(agents_keep_conversations_apart) :-
    with_platforms(_, Url,
        ( echo(beta, _),
          does(( send(fipa('echo@b', [Url]),
                      acl(request, [content([1]), conversation_id(one),
                                    reply_with(r1)])),
                 send(fipa('echo@b', [Url]),
                      acl(request, [content([2]), conversation_id(two)])),
                 receive(_-acl(inform, [conversation_id(two)|Two]), 10),
                 receive(_-acl(inform, [conversation_id(one)|One]), 10),
                 memberchk(in_reply_to(To), One),
                 memberchk(content([said(_, Second)]), Two) ),
               To-Second),
          assertion(To-Second == r1-[2]) )).

%   Agents and managers.

test(answer_goes_to_the_agent_that_is_named,
     [forall(member(To, [echo, ams]))]) :-
    with_platform([], _,
        ( echo(alpha, _),
          agent_create(clauses([ (:- agent(other, [])),
                                 (main :- receive(_-acl(Performative, _)),
                                          result(Performative)) ]),
                       Other, [host(alpha)]),
          atom_concat(To, '@a', Name),
          does(send(fipa(Name),
                    acl(request, [ content([action(fipa(Name),
                                                   'get-description'())]),
                                   reply_to([fipa('other@a')]) ])), sent),
          agent_result(Other, inform, 20) )).

test(forged_sender_is_replaced) :-
    with_platforms(_, Url,
        ( echo(beta, _),
          does(( self(Me),
                 send(fipa('echo@b', [Url]),
                      acl(request, [content([x]), sender(fipa(king))])),
                 receive(_-acl(inform, Parameters), 10),
                 memberchk(content([said(From, _)]), Parameters) ), Me-From),
          property(alpha, name(Me, Name)),
          assertion(From == fipa(Name, [])) )).

wrong(send(fipa('x@y'), acl(inform, [])),
      existence_error(fipa_address, 'x@y')).
wrong(send(fipa(x, ['ftp://h/']), acl(inform, [])), domain_error(http_url, _)).
wrong(send(fipa(x, ['http://h/']), acl(shout, [])), domain_error(performative, shout)).
wrong(send(fipa(x, ['http://h/']), hello), type_error(fipa_message, hello)).
wrong(send(fipa(x, ['http://h/']), acl(inform, [content(f(_))])), type_error(_, _)).
wrong(send(somebody(x), hello), type_error(receiver, somebody(x))).

test(agents_get_errors, [forall(wrong(Goal, Expected))]) :-
    with_platform([], _,
        ( does(catch(Goal, error(Formal, _), true), Formal),
          assertion(subsumes_term(Expected, Formal)) )).

test(agents_need_a_platform) :-
    with_hosts([alpha],
        ( does(catch(send(fipa(x, ['http://127.0.0.1:1/']), acl(inform, [])),
                     error(Formal, _), true), Formal),
          assertion(Formal = type_error(receiver, _)),
          does(catch(reply(acl(request, []), inform, x),
                     error(Formal1, _), true), Formal1),
          assertion(Formal1 = existence_error(procedure, _)) )).

test(agents_receive_failures) :-
    with_platforms(_, Url,
        ( free_port(Port),
          format(atom(Missing), 'http://127.0.0.1:~d/acc', [Port]),
          does(( fipa_request(fipa('unknown@b', [Url]), "x", 10, One),
                 fipa_request(fipa('x@y', [Missing]), "x", 10, Two) ),
               One-Two),
          assertion(One = failure-[action(_, _), _]),
          Two = failure-[_, Error],
          compound_name_arguments(Error, 'MTS-error', [Refused, _]),
          assertion(Refused == fipa('x@y', [Missing])),
          property(alpha, failed(1)),
          property(beta, failed(1)) )).

%   The second address is as good.

test(agents_are_found_at_any_address) :-
    with_platforms(_, Url,
        ( echo(beta, _),
          free_port(Port),
          format(atom(Missing), 'http://127.0.0.1:~d/acc', [Port]),
          does(fipa_request(fipa('echo@b', [Missing, Url]), "x", 10, Outcome),
               Outcome),
          assertion(Outcome = inform-_) )).

test(agents_are_reached_after_moves) :-
    no_leaks(with_peers([away],
        with_platforms(_, Url,
            ( peer_host(away, Away),
              agent_create(
                  clauses([ (:- agent(goer, [])),
                            (main :- attach(payloads(fipa/reply))),
                            (on_message(user, go(To)) :- move(To)),
                            (on_message(_, Acl) :-
                                 Acl = acl(_, _),
                                 here(Here),
                                 reply(Acl, inform, [on(Here)])) ]),
                  Agent, [host(beta)]),
              property(beta, name(Agent, Name)),
              does(fipa_request(fipa(Name, [Url]), "x", 10, Home), Home),
              agent_send(Agent, go(Away)),
              wait_until(agent_property(Agent, host(Away)), 10),
              does(fipa_request(fipa(Name, [Url]), "x", 10, There), There),
              atom_concat('away@', _, Away),
              assertion(There == inform-[on(Away)]),
              assertion(Home \== There),
              agent_dispose(Agent),
              agent_join(Agent, _, 10),
              does(fipa_request(fipa(Name, [Url]), "x", 10, Dead), Dead),
              assertion(Dead = failure-_) )))).

%   A visitor sends by way of its home.

test(agents_write_from_any_host) :-
    no_leaks(with_peers([away],
        with_platforms(_, Url,
            ( peer_host(away, Away),
              echo(beta, _),
              does(( move(Away),
                     fipa_request(fipa('echo@b', [Url]), [x], 10, Outcome) ),
                   Outcome),
              assertion(Outcome = inform-_),
              does(( move(Away),
                     fipa_request(fipa('none@b', [Url]), [x], 10, None) ),
                   None),
              assertion(None = failure-_) )))).

test(agents_perform_requests) :-
    with_platforms(_, Url,
        ( participant(one, 3),
          participant(two, 2),
          One = fipa('one@b', [Url]),
          Two = fipa('two@b', [Url]),
          does(( fipa_request(One, [action(One, add(1, 2))], 10, Sum),
                 fipa_request(One, [action(One, add(1, x))], 10, Failure),
                 fipa_request(One, [action(One, fly())], 10, Refusal),
                 fipa_call([One, Two], [action(One, add(2, 2))], 10, Proposals),
                 length(Proposals, Count),
                 msort(Proposals, [Best|_]),
                 fipa_award(Proposals, Best, 10, Outcome),
                 fipa_call([One, Two], [action(One, fly())], 10, Missing) ),
               [Sum, Failure, Refusal, Count, Outcome, Missing]),
          assertion(Sum == inform-[result(action(fipa('one@b', [Url]),
                                                 add(1, 2)), 3)]),
          assertion(Failure = failure-[action(_, _), _]),
          assertion(Refusal = refuse-[action(_, _), _]),
          assertion(Count == 2),
          assertion(Outcome = inform-[result(_, 4)]),
          assertion(Missing == []) )).

participant(Name, Price) :-
    agent_create(
        clauses([ (:- agent(participant, [])),
                  (main :- attach(payloads(fipa/participant))),
                  (on_message(_, Acl) :- fipa_take_part(Acl)),
                  (perform(add(A, B), C) :- C is A+B),
                  (bid(add(_, _), [price(Price)]) :- true) ]),
        _, [host(beta), name(Name)]).

:- end_tests(fipa_agents).

:- begin_tests(fipa_managers).

%   asked(+Manager, +Act, -Outcome)

asked(Manager, Act, Outcome) :-
    Aid = fipa(Manager),
    does(fipa_request(Aid, [action(Aid, Act)], 10, Outcome), Outcome).

description(Name, Type,
            'df-agent-description'(
                name:fipa(Name, []),
                services:set(['service-description'(type:Type)]))).

test(df) :-
    with_platform([], _,
        ( description('x@y', painting, Painter),
          description('x@y', singing, Singer),
          description('z@y', singing, Other),
          asked('df@a', register(Painter), One),
          assertion(One = inform-[done(action(_, register(Painter)))]),
          asked('df@a', register(Singer), Twice),
          assertion(Twice = failure-[_, 'already-registered']),
          asked('df@a', modify(Singer), Modified),
          assertion(Modified = inform-_),
          asked('df@a', register(Other), _),
          Template = 'df-agent-description'(
                         services:set(['service-description'(type:singing)])),
          asked('df@a', search(Template), inform-[result(_, Found)]),
          assertion(Found == [Singer, Other]),
          asked('df@a', search(Template, 'search-constraints'('max-results':1)),
                inform-[result(_, First)]),
          assertion(First == [Singer]),
          asked('df@a', deregister(Singer), Gone),
          assertion(Gone = inform-_),
          asked('df@a', deregister(Singer), Never),
          assertion(Never = failure-[_, 'not-registered']),
          asked('df@a', modify(Singer), Never2),
          assertion(Never2 = failure-[_, 'not-registered']) )).

test(df_lists_offers_of_agents) :-
    with_platform([], Url,
        ( agent_create(clauses([ (:- agent(shop, [])),
                                 (main :- offer(shop(tea), [price(7)]),
                                          receive(_-stop)) ]), Agent, []),
          wait_until(agent_property(Agent, state(waiting)), 10),
          property(alpha, name(Agent, Name)),
          description(_, shop, Template0),
          Template0 = 'df-agent-description'(_, Services),
          asked('df@a', search('df-agent-description'(Services)),
                inform-[result(_, [Found])]),
          assertion(Found = 'df-agent-description'(
                                name:fipa(Name, [Url]),
                                services:set([_]))),
          agent_dispose(Agent),
          asked('df@a', search('df-agent-description'(Services)),
                inform-[result(_, None)]),
          assertion(None == []) )).

test(ams) :-
    with_platform([], Url,
        ( echo(alpha, Agent),
          property(alpha, name(Agent, Name)),
          All = 'ams-agent-description'(name:fipa(Name, [])),
          asked('ams@a', search(All), inform-[result(_, [Found])]),
          assertion(Found == 'ams-agent-description'(name:fipa(Name, [Url]),
                                                     state:active)),
          asked('ams@a', register(All), Known),
          assertion(Known = failure-[_, 'already-registered']),
          asked('ams@a', deregister(All), No),
          assertion(No = refuse-[_, unauthorised]),
          asked('ams@a', 'get-description'(), inform-[result(_, [Platform])]),
          compound_name_arguments(Platform, 'ap-description', Parameters),
          assertion(memberchk(name:a, Parameters)),
          agent_dispose(Agent),
          agent_join(Agent, _, 10),
          asked('ams@a', search(All), inform-[result(_, None)]),
          assertion(None == []) )).

test(not_understood) :-
    with_platform([], _,
        ( asked('ams@a', dance(), Dance),
          assertion(Dance = refuse-[_, 'unsupported-function'(dance)]),
          asked('df@a', register(x), X),
          assertion(X = refuse-_),
          asked('df@a', register('df-agent-description'()), Nameless),
          assertion(Nameless = refuse-[_, 'missing-parameter'(_, name)]),
          does(fipa_request(fipa('df@a'), "((action", 10, Broken), Broken),
          assertion(Broken = 'not-understood'-_) )).

:- end_tests(fipa_managers).

:- begin_tests(fipa_service).

test(service_starts_once, error(permission_error(start, fipa, alpha))) :-
    with_platform([], _, fipa_start(alpha, 'http://127.0.0.1:0/b', [])).

test(service_needs_real_time, error(permission_error(start, fipa, alpha))) :-
    with_hosts([alpha-[clock(virtual)]],
               fipa_start(alpha, 'http://127.0.0.1:0/b', [])).

test(service_is_diagnosed) :-
    with_platform([], Url,
        ( with_output_to(string(Well), diagnose_fipa(Url)),
          assertion(sub_string(Well, _, _, _, "it takes messages")),
          atom_concat(Url, x, Wrong),
          with_output_to(string(Bad), \+ diagnose_fipa(Wrong)),
          assertion(sub_string(Bad, _, _, _, "FAIL  message")) )).

test(service_needs_a_host, error(existence_error(host, nowhere))) :-
    fipa_start(nowhere, 'http://127.0.0.1:0/b', []).

bad_start('ftp://127.0.0.1:0/', [], domain_error(http_url, _)).
bad_start('http://127.0.0.1:0/', [colour(red)], domain_error(fipa_option, _)).
bad_start('http://127.0.0.1:0/', [queue(0)], type_error(_, _)).
bad_start('http://127.0.0.1:0/', [name('a@b')], domain_error(fipa_platform, _)).

test(wrong_options_are_errors, [forall(bad_start(Url, Options, Expected))]) :-
    with_hosts([alpha],
        ( catch(fipa_start(alpha, Url, Options), error(Formal, _), true),
          assertion(subsumes_term(Expected, Formal)) )).

test(port_is_in_use) :-
    with_platform([], Url,
        with_hosts([beta],
            ( catch(fipa_start(beta, Url, []), error(Formal, _), true),
              assertion(Formal = socket_error(_, _)),
              catch(fipa_stop(beta), error(Formal1, _), true),
              assertion(Formal1 == existence_error(fipa, beta)) ))).

test(service_stops) :-
    with_platform([], Url,
        ( fipa_stop(alpha),
          assertion(\+ fipa_property(alpha, _)),
          fipa_start(alpha, Url, []),
          assertion(property(alpha, name(alpha))) )).

test(service_in_another_process, Names-After == [far]-[]) :-
    with_peers([p],
        ( peer_host(p, Host),
          fipa_start(Host, 'http://127.0.0.1:0/acc', [name(far)]),
          names(Host, Names),
          fipa_stop(Host),
          names(Host, After) )).

names(Host, Names) :-
    remote(Host, findall(Name, typhon_fipa_service:fipa_property(_, name(Name)),
                         Names)).

test(service_is_on_loopback) :-
    with_platform([], Url,
        ( port(Url, Port),
          tcp_socket(Socket),
          catch(tcp_connect(Socket, '127.0.0.2':Port), error(Formal, _),
                true),
          tcp_close_socket(Socket),
          assertion(Formal = socket_error(econnrefused, _)) )).

%   An agent that reads nothing.

test(queue_of_a_mailbox) :-
    with_platform([queue(3)], _,
        ( agent_create(clauses([ (:- agent(deaf, [])),
                                 (main :- receive(_-never)) ]), Deaf,
                       [host(alpha)]),
          wait_state(Deaf, waiting),
          does(( forall(member(N, [1,2,3,4,5]),
                        send(fipa('deaf@a'), acl(inform, [conversation_id(N)]))),
                 receive(_-acl(failure, [conversation_id(Four)|_]), 10),
                 receive(_-acl(failure, [conversation_id(Five)|_]), 10) ),
               [Four, Five]),
          assertion([Four, Five] == ['4', '5']),
          assertion(property(alpha, dropped(2))) )).

%   A peer that takes no messages: the sender gets a failure, and others are
%   not delayed.

test(queue_of_a_destination) :-
    with_platforms(_, Url,
        ( echo(beta, _),
          fipa_stop(alpha),
          platform(alpha, a, [queue(5), seconds(5)], _),
          with_silence(Silent,
              ( does(( filled(Silent, 0, Count, Formal),
                       fipa_request(fipa('echo@b', [Url]), "x", 20, Outcome),
                       receive(_-acl(failure, [conversation_id('0')|_]), 30) ),
                     [ (filled(To, N, Count, Formal) :-
                            N < 100,
                            catch(send(fipa(x, [To]),
                                       acl(inform, [conversation_id(N)])),
                                  error(Formal, _), true),
                            (   nonvar(Formal)
                            ->  Count = N
                            ;   N1 is N+1,
                                filled(To, N1, Count, Formal)
                            )) ],
                     Count-Formal-Outcome),
                assertion(Formal == resource_error(fipa_queue)),
                assertion(Count =< 7),
                assertion(Outcome = inform-_),
                assertion(property(alpha, dropped(1))) )) )).

:- meta_predicate with_silence(-, 0).

with_silence(Url, Goal) :-
    setup_call_cleanup(
        ( tcp_socket(Socket),
          tcp_bind(Socket, '127.0.0.1':Port),
          tcp_listen(Socket, 5),
          format(atom(Url), 'http://127.0.0.1:~d/acc', [Port]) ),
        once(Goal),
        tcp_close_socket(Socket)).

test(service_accepts_a_megabyte) :-
    with_platforms(_, Url,
        ( echo(beta, _),
          length(Codes, 1000000),
          maplist(=(0'x), Codes),
          string_codes(Big, Codes),
          string_concat(Big, Big, TooBig),
          does(( send(fipa('echo@b', [Url]), acl(request, [content(Big)])),
                 receive(_-acl(inform, Parameters), 100),
                 memberchk(content([said(_, Said)]), Parameters),
                 string_length(Said, Length),
                 catch(send(fipa('echo@b', [Url]),
                            acl(request, [content(TooBig)])),
                       error(Formal, _), true) ), Length-Formal),
          assertion(Length == 1000000),
          assertion(Formal == resource_error(fipa_message_bytes)) )).

:- end_tests(fipa_service).

                /*******************************
                *           REQUESTS           *
                *******************************/

port(Url, Port) :-
    atomic_list_concat([_, _, PortPath], :, Url),
    atomic_list_concat([PortText|_], /, PortPath),
    atom_number(PortText, Port).

connected(Url, In, Out, Goal) :-
    port(Url, Port),
    setup_call_cleanup(
        ( tcp_connect('127.0.0.1':Port, Stream, []),
          stream_pair(Stream, In, Out),
          set_stream(In, encoding(octet)),
          set_stream(Out, encoding(octet)),
          set_stream(In, newline(posix)),
          set_stream(Out, newline(posix)),
          set_stream(In, timeout(10)) ),
        once(Goal),
        ( close(Out, [force(true)]), close(In, [force(true)]) )).

%   sends(+Url, +Text, -Status): the answer to Text, or `closed`.

sends(Url, Text, Status) :-
    connected(Url, In, Out,
              ( catch(( write(Out, Text), flush_output(Out) ),
                      error(_, _), true),
                status(In, Status) )).

status(In, Status) :-
    catch(read_line(In, Line), error(_, _), Line = ""),
    (   split_string(Line, " ", "", [_, Code|_])
    ->  number_string(Status, Code)
    ;   Status = closed
    ).

read_line(In, Line) :-
    read_string(In, "\n", "\r", _, Line).

post(Type, Body, Text) :-
    string_length(Body, Length),
    format(string(Text),
           'POST /acc HTTP/1.1\r\nHost: x\r\nContent-Type: ~s\r\n\c
            Content-Length: ~d\r\n\r\n~s',
           [Type, Length, Body]).

%   acl(+Text, -Posted): Text to the agent echo@a, in its envelope.

acl(Text, Posted) :-
    format(string(Body),
           '--part\r\nContent-Type: application/xml\r\n\r\n\c
            <envelope><params index="1">\c
            <to><agent-identifier><name>echo@a</name>\c
            </agent-identifier></to>\c
            <from><agent-identifier><name>x</name><addresses>\c
            <url>http://127.0.0.1:1/</url></addresses>\c
            </agent-identifier></from>\c
            <acl-representation>fipa.acl.rep.string.std\c
            </acl-representation>\c
            <date>20261125T075835900</date>\c
            </params></envelope>\r\n\c
            --part\r\nContent-Type: application/text\r\n\r\n\c
            ~s\r\n--part--\r\n',
           [Text]),
    post("multipart/mixed; boundary=part", Body, Posted).

repeated(Text, Count, Repeated) :-
    findall(Text, between(1, Count, _), Texts),
    atomic_list_concat(Texts, Repeated).

bad(garbage, "\u0000\u0001\u00FF\n\n", 400).
bad(other_method, "GET /acc HTTP/1.1\r\n\r\n", 405).
bad(other_path, "POST /etc/passwd HTTP/1.1\r\nContent-Length: 0\r\n\r\n", 404).
bad(no_type, "POST /acc HTTP/1.1\r\nContent-Length: 0\r\n\r\n", 400).
bad(chunks, "POST /acc HTTP/1.1\r\nTransfer-Encoding: chunked\r\n\r\n", 411).
bad(negative, "POST /acc HTTP/1.1\r\nContent-Length: -1\r\n\r\n", 400).
bad(huge, "POST /acc HTTP/1.1\r\nContent-Length: 99999999999999\r\n\r\n", 413).
bad(endless_line, Text, 413) :-
    repeated("xxxxxxxxxx", 100000, Text).
bad(endless_head, Text, 413) :-
    repeated("X-Field: value\r\n", 100000, Head),
    atom_concat('POST /acc HTTP/1.1\r\n', Head, Text).
bad(broken_parts, Text, 400) :-
    post("multipart/mixed; boundary=x", "--x\r\n\r\nno end", Text).
bad(many_attributes, Text, 413) :-
    findall(Attribute,
            ( between(1, 40000, N), format(atom(Attribute), ' a~d=""', [N]) ),
            Attributes),
    atomic_list_concat(Attributes, All),
    format(string(Body), "--x\r\n\r\n<envelope><params~w></params></envelope>\c
           \r\n--x\r\n\r\n(inform)\r\n--x--\r\n", [All]),
    post("multipart/mixed; boundary=x", Body, Text).
bad(bomb, Text, 400) :-
    post("multipart/mixed; boundary=x",
         "--x\r\n\r\n<!DOCTYPE a [<!ENTITY b \"cccccccc\">]><envelope>&b;\c
          </envelope>\r\n--x\r\n\r\n(inform)\r\n--x--\r\n", Text).
bad(no_message, Text, 400) :-
    acl("(inform :content", Text).
bad(deep, Text, 400) :-
    repeated("(", 100000, Deep),
    acl(Deep, Text).
bad(bad_encoding, Text, 400) :-
    post("multipart/mixed; boundary=x",
         "--x\r\n\r\n<envelope><params><payload-encoding>x-none\c
          </payload-encoding></params></envelope>\r\n--x\r\n\r\n\c
          (inform :content \"\u00FF\")\r\n--x--\r\n", Text).

good(Text) :-
    acl("(inform :sender (agent-identifier :name x) :content \"y\")", Text).

:- begin_tests(fipa_requests).

test(good, Status == 200) :-
    with_platform([], Url, ( good(Text), sends(Url, Text, Status) )).

test(bad) :-
    with_platform([], Url,
        forall(bad(Name, Text, Expected),
               ( sends(Url, Text, Status),
                 assertion(Name-Status == Name-Expected),
                 good(Good),
                 sends(Url, Good, After),
                 assertion(Name-After == Name-200) ))),
    findall(x, bad(_, _, _), Bad),
    length(Bad, Count),
    assertion(Count == 15).

test(wrong_performative) :-
    with_platforms(_, Url,
        ( echo(beta, _),
          acl("(bark :sender (agent-identifier :name dog@x) :content \"y\")",
              Text),
          sends(Url, Text, Status),
          assertion(Status == 200),
          property(beta, received(1)) )).

%   Several requests on one connection.

test(connection_is_kept) :-
    with_platform([], Url,
        ( good(Text),
          connected(Url, In, Out,
              forall(member(_, [1,2,3]),
                     ( write(Out, Text), flush_output(Out),
                       status(In, Status),
                       assertion(Status == 200),
                       rest(In) ))) )).

rest(In) :-
    repeat,
    read_line(In, ""),
    !,
    read_line(In, _).

test(body_is_requested) :-
    with_platform([], Url,
        ( good(Text),
          string_concat("POST /acc HTTP/1.1\r\n", Rest, Text),
          string_concat("POST /acc HTTP/1.1\r\nExpect: 100-continue\r\n", Rest,
                        Asking),
          connected(Url, In, Out,
              ( write(Out, Asking), flush_output(Out),
                status(In, First), read_line(In, ""), status(In, Second) )),
          assertion(First-Second == 100-200) )).

%   A byte now and then does not keep a connection open.

test(slow_peer) :-
    with_platform([seconds(1)], Url,
        connected(Url, In, Out,
            ( write(Out, 'POST /acc HTTP/1.1\r\n'),
              thread_self(Me),
              thread_create(drip(Out, Me), Drip),
              status(In, Status),
              thread_send_message(Drip, stop),
              thread_join(Drip),
              assertion(Status == 408) ))).

drip(Out, Whom) :-
    thread_self(Me),
    (   thread_get_message(Me, stop, [timeout(0.1)])
    ->  true
    ;   catch(( put_byte(Out, 0'x), flush_output(Out) ), error(_, _), fail)
    ->  drip(Out, Whom)
    ;   thread_get_message(Me, stop)
    ).

%   Silent clients are disconnected first.

test(silent_clients) :-
    with_platform([connections(4)], Url,
        ( port(Url, Port),
          findall(Stream,
                  ( between(1, 10, _),
                    tcp_connect('127.0.0.1':Port, Stream, []) ),
                  Streams),
          good(Text),
          sends(Url, Text, Status),
          assertion(Status == 200),
          maplist(close, Streams) )).

%   A client with an incomplete request is disconnected first, too.

test(incomplete_requests_are_dropped_first, Statuses == [200, 200, 200]) :-
    with_platform([connections(8)], Url,
        ( findall(Stream,
                  ( between(1, 100, _), half_request(Url, Stream) ),
                  Streams),
          good(Text),
          findall(Status, ( between(1, 3, _), sends(Url, Text, Status) ),
                  Statuses),
          maplist(shut, Streams) )).

half_request(Url, Stream) :-
    port(Url, Port),
    tcp_connect('127.0.0.1':Port, Stream, []),
    catch(( write(Stream, 'POST /acc'), flush_output(Stream) ),
          error(_, _), true).

%   An address with few connections keeps them: its request begins before, and
%   ends after, many requests of another address.

test(one_address_does_not_displace_another, Status == 200) :-
    with_platform([connections(4), seconds(60)], Url,
        ( port(Url, Port),
          good(Text),
          sub_string(Text, 0, 20, _, Begin),
          sub_string(Text, 20, _, 0, End),
          setup_call_cleanup(
              ( tcp_socket(Socket),
                tcp_bind(Socket, '127.0.0.2':_),
                tcp_connect(Socket, '127.0.0.1':Port),
                tcp_open_socket(Socket, In, Out),
                maplist([S]>>set_stream(S, encoding(octet)), [In, Out]),
                maplist([S]>>set_stream(S, newline(posix)), [In, Out]) ),
              ( write(Out, Begin), flush_output(Out),
                findall(Stream,
                        ( between(1, 30, _), half_request(Url, Stream) ),
                        Streams),
                sends(Url, Text, Other),
                assertion(Other == 200),
                write(Out, End), flush_output(Out),
                status(In, Status),
                maplist(shut, Streams) ),
              ( shut(Out), shut(In) )) )).

shut(Stream) :-
    close(Stream, [force(true)]).

:- end_tests(fipa_requests).
