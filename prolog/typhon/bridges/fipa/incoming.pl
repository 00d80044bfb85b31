:- module(typhon_fipa_incoming, []).
:- use_module(library(debug), [debug/3]).
:- use_module(library(lists), [member/2]).
:- use_module(acl, [acl_parameter/2, acl_text/2, acl_with/3]).
:- use_module(exchange, [exchange_receive/3]).
:- use_module(http, [http_url/3]).
:- use_module(letter, [letter_read/4]).
:- use_module(platform, [platform/4, platform_count/2]).
:- use_module(aid, [aid_addresses/2, aid_name/2]).

/** <module> What a request of another platform comes to

*Threading*: in the thread of the client.
*/

:- multifile typhon_fipa_reception:requested/3.

typhon_fipa_reception:requested(Host, Request, Code) :-
    platform(Host, _, Url, _),
    catch(message(Request, Url, Message), error(Formal, _),
          Message = bad(Formal)),
    taken(Message, Host, Code).

taken(message(Acl, Receivers), Host, Code) =>
    forall(member(Receiver, Receivers),
           exchange_receive(Host, Receiver, Acl)),
    Code = 200.
taken(bad(Why), Host, Code) =>
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

message(request(Method, _, _, _, _), _, Message), Method \== 'POST' =>
    Message = bad(405).
message(request(_, Target, _, _, _), Url, Message), \+ at(Target, Url) =>
    Message = bad(404).
message(request(_, _, Type, Body, _), _, Message) =>
    letter_read(Type, Body, Envelope, Text),
    acl_text(Acl0, Text),
    from(Acl0, Envelope, Acl),
    receivers(Acl, Envelope, Receivers),
    Message = message(Acl, Receivers).

%   JADE's requests have the whole URL.

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
