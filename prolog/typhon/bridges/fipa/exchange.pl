:- module(typhon_fipa_exchange,
          [ exchange_send/4,            % +Host, +Local, +To, +Acl
            exchange_received/3         % +Host, +Request, -Code
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
:- use_module(sexp, [aid_addresses/2, aid_name/2]).
:- use_module(carriage, [carriage_send/4]).
:- use_module(http, [http_url/3]).
:- use_module(letter, [letter_read/4, letter_write/5]).
:- use_module(managers, [manager_answer/4]).
:- use_module(platform,
              [ platform/4, platform_aid/3, platform_count/2,
                platform_local/3, platform_met/2, platform_way/2 ]).

/** <module> Messages between agents of this platform and of others

A message from another platform is posted to its receiver like all messages, on
whatever host that agent is, or handled by a manager.  A message to another
platform is sent to the addresses of its receiver.  If a message cannot be
delivered, the AMS sends a failure to its sender.

*Threading*: any thread.  exchange_send/4 does not wait for other platforms.
Requests are handled in the thread of the client, which may wait for a
connection to another process of the network.
*/

:- multifile
    typhon_fipa_carriage:returned/4,
    typhon_mail:returned/3.

                /*******************************
                *           SENDING            *
                *******************************/

%!  exchange_send(+Host, +Local, +To, +Acl) is det.
%
%   Send Acl to the agent identifier To, from Local, an agent's id or a manager,
%   through Host.  The sender is always Local, also if Acl names another one;
%   the receiver is To unless Acl names one.
%
%   @error existence_error(fipa_address, Name) if no address of To is known
%   @error resource_error(fipa_message_bytes), and the errors of acl_text/2 and
%   carriage_send/4

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
        accept(Host, To, Read)
    ;   send_to_platform(Host, Local, To, Acl, Text),
        platform_count(Host, sent)
    ).

send_to_platform(Host, Local, To, Acl, Text) :-
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
                *          RECEIVING           *
                *******************************/

%!  exchange_received(+Host, +Request, -Code) is det.
%
%   Deliver the message in Request, as of http_request/4.  Code is the HTTP
%   status of the response.

exchange_received(Host, Request, Code) :-
    platform(Host, _, Url, _),
    catch(message(Request, Url, Message), error(Formal, _),
          Message = bad(Formal)),
    handle(Message, Host, Code).

handle(message(Acl, Receivers), Host, Code) =>
    forall(member(Receiver, Receivers),
           accept(Host, Receiver, Acl)),
    Code = 200.
handle(bad(Why), Host, Code) =>
    debug(typhon(fipa), '~w: a request is no message: ~p', [Host, Why]),
    platform_count(Host, refused),
    (   integer(Why)
    ->  Code = Why
    ;   Why = resource_error(fipa_envelope)
    ->  Code = 413
    ;   Code = 400
    ).

%   message(+Request, +Url, -Message): Message is message(Acl, Receivers), or
%   bad(Code).

message(request(Method, _, _, _, _), _, Message), Method \== post =>
    Message = bad(405).
message(request(_, Target, _, _, _), Url, Message), \+ at(Target, Url) =>
    Message = bad(404).
message(request(_, _, Type, Body, _), _, Message) =>
    letter_read(Type, Body, Envelope, Text),
    acl_text(Acl0, Text),
    from(Acl0, Envelope, Acl),
    receivers(Acl, Envelope, Receivers),
    Message = message(Acl, Receivers).

%   JADE sends the whole URL as the target of a request.

at(Target, Url) :-
    http_url(Url, _, Path),
    (   Target == Path
    ->  true
    ;   catch(http_url(Target, _, Path), error(_, _), fail)
    ).

%   The envelope may name the sender if the message does not.

from(Acl0, Envelope, Acl) :-
    (   acl_parameter(Acl0, sender(Sender0))
    ->  with_addresses(Sender0, Envelope, Sender)
    ;   memberchk(from(Sender), Envelope)
    ),
    acl_with(Acl0, [sender(Sender)], Acl).

with_addresses(Sender, Envelope, WithAddresses) :-
    aid_addresses(Sender, []),
    memberchk(from(From), Envelope),
    aid_name(Sender, Name),
    aid_name(From, Name),
    !,
    WithAddresses = From.
with_addresses(Sender, _, Sender).

receivers(Acl, Envelope, Receivers) :-
    (   memberchk(intended_receiver(Receivers0), Envelope)
    ;   memberchk(to(Receivers0), Envelope)
    ;   acl_parameter(Acl, receiver(Receivers0))
    ),
    !,
    Receivers = Receivers0.

%   accept(+Host, +Aid, +Acl): deliver Acl to Aid, on the platform of Host.

accept(Host, Aid, Acl) :-
    local_name(Host, Aid, Local),
    acl_parameter(Acl, sender(Sender)),
    aid_name(Sender, From),
    aid_addresses(Sender, Addresses),
    platform_met(From, Addresses),
    platform_count(Host, received),
    debug(typhon(fipa), '~w: ~w gets ~p', [Host, Local, Acl]),
    receive(Local, Host, Aid, Acl).

local_name(Host, Aid, Local) :-
    aid_name(Aid, Name),
    (   platform_local(Host, Name, Local0)
    ->  Local = Local0
    ;   Local = Name
    ).

receive(Manager, Host, _, Acl), manager(Manager) =>
    (   manager_answer(Host, Manager, Acl, Performative-Content)
    ->  acl_reply(Acl, Performative, Content, Reply),
        answer(Host, Manager, Acl, Reply)
    ;   true
    ).
receive(Local, Host, _, Acl), Acl = acl(Performative, _),
                              \+ performative(Performative) =>
    acl_reply(Acl, 'not-understood', ['unrecognised-value'(Performative)],
              Reply),
    answer(Host, Local, Acl, Reply).
receive(Local, Host, Aid, Acl) =>
    catch(to_agent(Local, Host, Acl), error(Formal, _),
          undelivered(Formal, Host, Aid, Acl)).

manager(ams).
manager(df).

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

%   The id of an agent names its process.  Messages of other platforms must not
%   make this process connect to processes to which it has never been connected.

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

%   post/3 has accepted this message, but it could not be delivered later.

typhon_mail:returned(fipa(_), Id, Acl) :-
    acl_parameter(Acl, via(Address)),
    platform(Host, _, _, _),
    host_address(Host, Address),
    !,
    platform_aid(Host, Id, Aid),
    acl_parameter(Acl, sender(Sender)),
    fail_to_sender(Host, Sender, Aid, Acl, "no such agent").

%   A failure is never answered with a failure: two platforms would loop.

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

%   The form is that of JADE, whose agents match it.

failure(Sender, To, Acl0, Why, Failure) :-
    acl_with(Acl0, [ language('fipa-sl'),
                     ontology('fipa-agent-management') ],
             Acl),
    acl_reply(Acl, failure,
              [ action(Sender, Message),
                'MTS-error'(To, 'internal-error'(Why)) ],
              Failure),
    compound_name_arguments(Message, 'ACLMessage', []).
