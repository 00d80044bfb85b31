:- module(typhon_bridge, []).

/** <module> The common part of bridges

A bridge makes an external system, such as a broker or a middleware, a service
of the place of a host.  Agents on the host call its predicates, and incoming
data reach them as messages or as facts.  This is the interface of the layer.  A
bridge `echo` in outline:

    % echo_start(Host, What, Options), see typhon_starting, comes here
    typhon_starting:starts(echo, Host, What, Options) :-
        service_begin(echo, Host, [shout/1, listen/1], typhon_echo_words,
                      helper_open(echo(Host), ...)).

    % in module typhon_echo_words, called by an agent on Host
    listen(Key) :-
        subscriber(Host, Agent),
        subscribe(echo, Host, Key, Agent, []),  % then ask the helper for Key
        ...

    % incoming data, in the thread that reads from the helper
    typhon_helper_owner:handle_message(echo(Host), Dict) :-
        subscribers_notify(echo, Host, Dict.key, said(Dict.text), said(_)).

    % the last subscriber of Key is gone
    typhon_subscribers:wanted(echo, Host, Key, false) :-
        helper_note(echo(Host), _{do:unsubscribe, key:Key}).

    % the host stops, or echo_stop(Host) is called
    typhon_starting:ends(echo, Host) :-
        helper_close(echo(Host)).
*/

:- reexport(common/http_server).
:- reexport(common/inbox, [inbox_put/4]).
:- reexport(common/starting,
            [service/2, service_begin/5, service_offer/4]).
:- reexport(common/subscribers,
            [ subscribe/5, subscriber/2, subscribers_drop/4,
              subscribers_notify/5, subscribers_notify_new/5, subscription/3,
              unsubscribe/4 ]).
