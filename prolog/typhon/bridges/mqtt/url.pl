:- module(typhon_mqtt_url,
          [ mqtt_url/2                  % +URL, -Parts
          ]).
:- use_module(library(error), [domain_error/2]).
:- use_module(library(uri),
              [ uri_authority_components/2, uri_authority_data/3,
                uri_components/2, uri_data/3,
                uri_encoded/3 ]).

/** <module> The URLs of brokers

*Threading*: pure.
*/

%!  mqtt_url(+URL, -Parts:dict) is det.
%
%   URL is mqtt://User:Password@Host:Port, or mqtts:// for TLS; all but the
%   host may be missing.  Parts are `host`, `port`, `tls`, and `user` and
%   `password` where they are said.
%
%   @error domain_error(mqtt_url, URL)

mqtt_url(URL, Parts) :-
    (   catch(parts(URL, Parts0), error(_, _), fail)
    ->  Parts = Parts0
    ;   domain_error(mqtt_url, URL)
    ).

parts(URL, Parts) :-
    uri_components(URL, Components),
    uri_data(scheme, Components, Scheme),
    scheme(Scheme, TLS, Default),
    uri_data(authority, Components, Authority),
    uri_authority_components(Authority, Data),
    uri_authority_data(host, Data, Host0),
    nonvar(Host0),
    bare(Host0, Host),
    Host \== '',
    uri_authority_data(port, Data, Port0),
    ( var(Port0) -> Port = Default ; integer(Port0), Port = Port0 ),
    between(1, 65535, Port),
    login(Data, Login),
    Parts = Login.put(_{host:Host, port:Port, tls:TLS}).

scheme(mqtt, false, 1883).
scheme(mqtts, true, 8883).

%   IPv6 addresses are in brackets.

bare(Host0, Host) :-
    (   atomic_list_concat(['', Rest], '[', Host0),
        atomic_list_concat([Inner, ''], ']', Rest)
    ->  Host = Inner
    ;   Host = Host0
    ).

login(Data, Login) :-
    uri_authority_data(user, Data, User0),
    (   var(User0)
    ->  Login = _{}
    ;   uri_encoded(segment, User, User0),
        uri_authority_data(password, Data, Password0),
        (   var(Password0)
        ->  Login = _{user:User}
        ;   uri_encoded(segment, Password, Password0),
            Login = _{user:User, password:Password}
        )
    ).
