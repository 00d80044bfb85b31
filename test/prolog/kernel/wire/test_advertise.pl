:- module(test_advertise, []).

% The address that a process announces: the interface at which it listens, or
% that of advertise(Address), as behind NAT.

:- use_module('../../../lib/common').
:- use_module('../../../lib/authority').
:- use_module('../../../lib/fixtures').
:- use_module('../../../lib/peers').
:- use_module(library(debug), [assertion/1]).
:- use_module(library(lists), [member/2]).
:- use_module(library(plunit)).
:- use_module(library(typhon)).
:- use_module(library(typhon/kernel/base/error_lines), [error_text/2]).
:- use_module(library(typhon/kernel/wire/addresses), [endpoint_parts/3]).

elsewhere(Options) :-
    Options = [bind('0.0.0.0'), advertise('127.0.0.2')].

:- needs([journal, openssl]).

:- begin_tests(advertise).

test(agents_and_replies_use_the_advertised_address) :-
    elsewhere(Options),
    with_peers([beta-[host(Options)]], with_hosts([alpha], visited)).
test(with_keys_as_well) :-
    with_authority([alpha, beta], [], with_keys).
test(later_hosts_share_the_address, true(I == '127.0.0.2')) :-
    elsewhere(Options),
    free_port(P),
    with_hosts([alpha-Options, beta, gamma-[port(P)|Options]],
               ( interface(alpha, I), interface(beta, I),
                 address(gamma, Gamma),
                 atom_concat('gamma@127.0.0.2:', P, Gamma),
                 remote(Gamma, true) )).
test(own_address_needs_no_network) :-
    with_hosts([alpha-[advertise('alpha.invalid:9')]],
               ( address(alpha, Address),
                 assertion(Address == 'alpha@alpha.invalid:9'),
                 remote(Address, true),
                 create([( main :- move(Address) )], Agent),
                 joined(Agent, done) )).
test(port_before_a_proxy_is_announced) :-
    with_peers([beta-[proxy(true)]],
               ( peer_host(beta, Known),
                 peer_do(beta, host_property(beta, address(Own))),
                 assertion(Own == Known),
                 remote(Known, true) )).
test(journal_keeps_the_address, true(Before == After)) :-
    elsewhere(Options),
    with_tmp_dir(restarted(Options, Before, After)).
test(processes_of_a_network_share_the_name, true(Interfaces == [I, I])) :-
    I = '127.0.0.2',
    no_leaks(setup_call_cleanup(
                 network_start(line(2), Network,
                               [ processes(2), bind('0.0.0.0'),
                                 advertise(I) ]),
                 ( network_property(Network, hosts(Hosts)),
                   findall(Interface,
                           ( member(Host, Hosts), remote(Host, true),
                             interface(Host, Interface) ),
                           Interfaces) ),
                 network_stop(Network))).
test(network_takes_no_port, error(domain_error(advertised_address, _))) :-
    network_start(line(2), _, [advertise('127.0.0.2:9')]).
test(another_address_than_before, error(permission_error(change, endpoint, _))) :-
    with_hosts([alpha], host_start(beta, [advertise('127.0.0.2')])).

test(unreachable_interface_is_refused,
     [ forall(member(Options, [ [bind('0.0.0.0')], [bind('0')], [bind('0.0')],
                                [bind('0x0')], [bind('0.0.0.0'),
                                                advertise('0.0.0.0:7')] ])),
       true(sub_string(Text, _, _, _, "--advertise=")) ]) :-
    refused(Options, Text).
test(what_is_no_address_is_refused,
     [ forall(member(Options, [ [bind('::1')], [bind('[::1]')], [bind('::')],
                                [bind('')], [bind('a b')], [bind('a@b')],
                                [advertise('[::1]:7')], [advertise('::1')],
                                [advertise('a:0')], [advertise('a:70000')],
                                [advertise('a b')], [advertise('a\nb')],
                                [advertise('h\u00e9')], [advertise('')],
                                [log('log@[::1]:7')] ])),
       true(sub_string(Text, _, _, _, "IPv6 addresses are not supported")) ]) :-
    refused(Options, Text).
test(address_of_a_host_in_ipv6_is_refused,
     [ forall(member(Address, ['b@[::1]:3000', 'b@::1:3000'])),
       error(domain_error(endpoint_address, _)) ]) :-
    with_hosts([alpha], link(alpha, Address)).

:- end_tests(advertise).

%   The agent goes to beta, home, and to beta again, and answers a message there.

visited :-
    peer_do(beta, host_property(beta, address(Beta))),
    interface(Beta, '127.0.0.2'),
    address(alpha, Alpha),
    create([ (main :- move(Beta), here(Beta), move(Alpha), move(Beta),
                      receive(From-ask), hops(N), send(From, hops(N))) ],
           Agent),
    create([( main :- self(Me), send(Agent, ask), receive(_-hops(N)),
                      leave(Me-N) )], Asker),
    joined(Asker, done),
    joined(Agent, done),
    remote(alpha, take(Asker-Hops)),
    assertion(Hops == 3).

with_keys(Authority) :-
    keys_of(alpha, Authority, Alpha),
    keys_of(beta, Authority, Beta),
    elsewhere(Options),
    with_peers([beta-[host([tls(Beta)|Options])]],
               ( with_hosts([alpha-[tls(Alpha)]], visited),
                 with_hosts([plain], is_stranger) )).

%   A process without keys.

is_stranger :-
    peer_do(beta, host_property(beta, address(Beta))),
    catch(remote(Beta, true), error(Formal, _), true),
    assertion(nonvar(Formal)).

restarted(Options, Before, After, Dir) :-
    with_hosts([alpha-[journal(Dir)|Options]], address(alpha, Before)),
    with_hosts([alpha-[journal(Dir)]], address(alpha, After)).

refused(Options, Text) :-
    catch(( host_start(alpha, Options), host_stop(alpha) ), Error, true),
    assertion(nonvar(Error)),
    error_text(Error, Text),
    assertion(\+ sub_string(Text, _, _, _, "\n")).

interface(Host, Interface) :-
    ( host_property(Host, address(Address)) -> true ; Address = Host ),
    atomic_list_concat([_, Endpoint], @, Address),
    endpoint_parts(Endpoint, Interface, _).
