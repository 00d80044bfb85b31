:- module(typhon_fipa_exchange,
          [ exchange_send/4,            % +Host, +Local, +To, +Acl
            exchange_receive/3          % +Host, +Aid, +Acl
          ]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(error), [existence_error/2, resource_error/1]).
:- use_module(library(lists), [member/2]).
:- use_module(library(option), [option/2]).
:- use_module('../../kernel/wire', [endpoint_address/1, endpoint_peer/2]).
:- use_module('../../kernel/host', [host_address/2]).
:- use_module('../../kernel/agent', [agent_home_endpoint/2, mail_count/2]).
:- use_module('../../kernel/travel', [post/3, whereabouts/2]).
:- use_module('../../kernel/lifecycle', [agent_named/2]).
:- use_module(acl,
              [ acl_parameter/2, acl_reply/4, acl_text/2, acl_with/3,
                must_be_acl/1, performative/1 ]).
:- use_module(aid, [aid_addresses/2, aid_name/2]).
:- use_module(carriage, [carriage_send/4]).
:- use_module(letter, [letter_write/5]).
:- use_module(managers, [manager_answer/4]).
:- use_module(platform,
              [ platform/4, platform_aid/3, platform_count/2,
                platform_local/3, platform_met/2, platform_way/2 ]).

/** <module> Messages between our agents and those of other platforms

What comes in goes to an agent by the way of all messages, wherever it is,
or to a manager.  What goes out goes to the addresses of its receiver.  For
what nobody takes the AMS sends a failure to the sender.

*Threading*: any thread.  exchange_send/4 does not wait for other platforms;
exchange_receive/3 may wait for a connection to another process of ours.
*/

:- multifile
    typhon_fipa_carriage:returned/4,
    typhon_lost:returned/3.

                /*******************************
                *              OUT             *
                *******************************/

%!  exchange_send(+Host, +Local, +To, +Acl) is det.
%
%   Send Acl to the agent identifier To, from Local, an agent's id or a
%   manager, by way of Host.  The sender is who it is, whatever Acl says; the
%   receiver is To where Acl says nothing.
%
%   @error existence_error(fipa_address, Name) if nobody has said where To is
%   @error resource_error(fipa_message_bytes), and what acl_text/2,
%   carriage_send/4 raise

exchange_send(Host, Local, To, Acl0) :-
    must_be_acl(Acl0),
    platform_aid(Host, Local, Sender),
    acl_with(Acl0, [sender(Sender)], Acl1),
    (   acl_parameter(Acl1, receiver(_))
    ->  Acl = Acl1
    ;   acl_with(Acl1, [receiver([To])], Acl)
    ),
    acl_text(Acl, Text),
    aid_name(To, Name),
    (   platform_local(Host, Name, _)
    ->  acl_text(Read, Text),
        platform_count(Host, sent),
        exchange_receive(Host, To, Read)
    ;   send_abroad(Host, Local, To, Acl, Text),
        platform_count(Host, sent)
    ).

send_abroad(Host, Local, To, Acl, Text) :-
    platform_way(To, Addresses),
    platform(Host, _, _, Limits),
    acl_parameter(Acl, sender(Sender)),
    aid_name(To, Name),
    letter_write(Text, Sender, fipa(Name, Addresses), Type, Body),
    option(max_bytes(Max), Limits),
    (   string_length(Body, Length),
        Length =< Max
    ->  true
    ;   resource_error(fipa_message_bytes)
    ),
    without_content(Acl, About),
    catch(carriage_send(Host, Addresses,
                        letter(Type, Body, about(Local, To, About)), Limits),
          error(resource_error(What), Context),
          ( platform_count(Host, dropped),
            throw(error(resource_error(What), Context)) )).

without_content(acl(Performative, Parameters), acl(Performative, Kept)) :-
    findall(Parameter,
            ( member(Parameter, Parameters),
              Parameter \= content(_) ),
            Kept).

typhon_fipa_carriage:returned(Host, about(Local, To, Acl), Url, Why) :-
    format(string(Text), '~w: ~s', [Url, Why]),
    fail_to(Host, Local, To, Acl, Text).

                /*******************************
                *              IN              *
                *******************************/

%!  exchange_receive(+Host, +Aid, +Acl) is det.
%
%   Acl has come for Aid, on the platform of Host.

exchange_receive(Host, Aid, Acl) :-
    aid_name(Aid, Name),
    (   platform_local(Host, Name, Local)
    ->  true
    ;   Local = Name
    ),
    acl_parameter(Acl, sender(Sender)),
    aid_name(Sender, From),
    aid_addresses(Sender, Addresses),
    platform_met(From, Addresses),
    platform_count(Host, received),
    debug(typhon(fipa), '~w: ~w gets ~p', [Host, Local, Acl]),
    receive(Local, Host, Aid, Acl).

receive(Manager, Host, _, Acl), manager(Manager) =>
    (   manager_answer(Host, Manager, Acl, Performative-Content)
    ->  acl_reply(Acl, Performative, Content, Reply),
        answer(Host, Manager, Acl, Reply)
    ;   true
    ).
receive(_, Host, Aid, Acl), Acl = acl(Performative, _),
                            \+ performative(Performative) =>
    acl_reply(Acl, 'not-understood', ['unrecognised-value'(Performative)],
              Reply),
    aid_name(Aid, Name),
    local_name(Host, Name, Local),
    answer(Host, Local, Acl, Reply).
receive(Local, Host, Aid, Acl) =>
    catch(to_agent(Local, Host, Acl), error(Formal, _),
          undelivered(Formal, Host, Aid, Acl)).

manager(ams).
manager(df).

local_name(Host, Name, Local) :-
    (   platform_local(Host, Name, Local0)
    ->  Local = Local0
    ;   Local = Name
    ).

answer(Host, Local, Acl, Reply) :-
    reply_to(Acl, To),
    catch(exchange_send(Host, Local, To, Reply), error(Formal, _),
          ( platform_count(Host, failed),
            debug(typhon(fipa), '~w: no answer for ~p: ~p',
                  [Host, To, Formal]) )).

reply_to(Acl, To) :-
    (   acl_parameter(Acl, reply_to([To0|_]))
    ->  To = To0
    ;   acl_parameter(Acl, sender(To))
    ).

to_agent(Local, Host, Acl) :-
    known_agent(Local, Id),
    platform(Host, _, _, Limits),
    option(queue(Most), Limits),
    (   mail_count(Id, Count),
        Count < Most
    ->  true
    ;   resource_error(fipa_queue)
    ),
    host_address(Host, Address),
    acl_with(Acl, [via(Address)], Mail),
    acl_parameter(Acl, sender(Sender)),
    aid_name(Sender, From),
    post(Id, fipa(From), Mail).

%   An id says to which process one has to turn: only to such as have been met
%   before.

known_agent(Local, Id) :-
    agent_named(Local, Id),
    (   agent_home_endpoint(Id, Endpoint),
        ( endpoint_address(Endpoint) ; endpoint_peer(Endpoint, _) )
    ->  true
    ;   whereabouts(Id, _)
    ->  true
    ;   existence_error(agent, Id)
    ).

undelivered(Formal, Host, Aid, Acl) :-
    (   Formal = resource_error(_)
    ->  platform_count(Host, dropped)
    ;   true
    ),
    why(Formal, Why),
    acl_parameter(Acl, sender(Sender)),
    fail_to_sender(Host, Sender, Aid, Acl, Why).

why(existence_error(agent, _), "no such agent") :- !.
why(resource_error(fipa_queue), "its mailbox is full") :- !.
why(Formal, Why) :-
    format(string(Why), '~p', [Formal]).

%   What post/3 took, and found nobody for later on.

typhon_lost:returned(fipa(_), Id, Acl) :-
    acl_parameter(Acl, via(Address)),
    platform(Host, _, _, _),
    host_address(Host, Address),
    !,
    platform_aid(Host, Id, Aid),
    acl_parameter(Acl, sender(Sender)),
    fail_to_sender(Host, Sender, Aid, Acl, "no such agent").

                /*******************************
                *           FAILURES           *
                *******************************/

%   No failure is sent about a failure: it would go on for ever.

fail_to(Host, Local, To, Acl, Why) :-
    (   manager(Local)
    ->  platform_count(Host, failed)
    ;   platform_aid(Host, Local, Sender),
        fail_to_sender(Host, Sender, To, Acl, Why)
    ).

fail_to_sender(Host, Sender, To, Acl, Why) :-
    platform_count(Host, failed),
    debug(typhon(fipa), '~w: ~p did not get ~p: ~s', [Host, To, Acl, Why]),
    (   Acl = acl(Performative, _),
        memberchk(Performative, [failure, 'not-understood'])
    ->  true
    ;   failure(Sender, To, Acl, Why, Failure),
        answer(Host, ams, Acl, Failure)
    ).

%   As JADE says it, whose agents look for that.

failure(Sender, To, Acl0, Why, Failure) :-
    acl_with(Acl0, [ language('fipa-sl'),
                     ontology('fipa-agent-management') ],
             Acl),
    acl_reply(Acl, failure,
              [ action(Sender, Message),
                'MTS-error'(To, 'internal-error'(Why)) ],
              Failure),
    compound_name_arguments(Message, 'ACLMessage', []).
